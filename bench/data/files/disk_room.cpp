#include "files/disk_room.h"

#include <cerrno>
#include <system_error>

#include <fmt/core.h>

#include "files/in_gibibytes.h"
#include "files/whole_file.h"

namespace kerf::bench {

void require_disk(const std::filesystem::path& file, std::uintmax_t bytes, std::string_view needed_for) {
  std::error_code unknown;
  const auto room = std::filesystem::space(existing_folder_of(file), unknown).available;
  if (unknown || bytes <= room) return;
  throw std::system_error(ENOSPC, std::generic_category(),
                          fmt::format("{}: needs about {} of the disk for {}, and {} can be had",
                                      file.string(), in_gibibytes(bytes), needed_for, in_gibibytes(room)));
}

}  // namespace kerf::bench
