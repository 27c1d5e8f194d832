#include "plan/file_of_sweep.h"

#include <array>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace kerf::bench {

void refuse_file_of_sweep(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return;
  std::array<char, 64> bytes{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), bytes.size());
  const std::string_view begin(bytes.data(), static_cast<std::size_t>(stream.gcount()));
  if (begin.starts_with('{') && begin.find("\"kerf.sweep ") != std::string_view::npos)
    throw std::invalid_argument(
        fmt::format("{}: the plan of a sweep, and no recording; 'kerf sweep status' says how far that is",
                    file.string()));
  constexpr std::size_t kind_of_record = 8;  // behind its length and its checksum
  if (begin.size() > kind_of_record && begin[kind_of_record] == 'H' &&
      begin.find("\"kerf.shard ") != std::string_view::npos)
    throw std::invalid_argument(fmt::format(
        "{}: a shard of a sweep, and no recording; 'kerf sweep merge' makes tables of all shards of "
        "a plan, 'kerf sweep status' looks through them",
        file.string()));
}

}  // namespace kerf::bench
