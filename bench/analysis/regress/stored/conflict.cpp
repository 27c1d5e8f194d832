#include "regress/stored/conflict.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

namespace kerf::bench {

void require_no_conflict(const std::filesystem::path& file, std::string_view text, const Suite& suite) {
  if (text.starts_with("version https://git-lfs"))
    throw std::invalid_argument(fmt::format(
        "{}: a pointer of Git LFS stands in its place; 'git lfs pull' fetches it", file.string()));
  constexpr std::string_view mark = "<<<<<<< ";
  std::size_t at = text.starts_with(mark) ? 0 : text.find("\n<<<<<<< ");
  if (at == std::string_view::npos) return;
  if (at > 0) ++at;
  throw std::invalid_argument(
      fmt::format("{}:{}: a merge left a conflict here, so that nobody knows which forces are right; take "
                  "one side of all "
                  "that is stored beside {} ('git checkout --ours' or '--theirs'), then 'kerf regress update "
                  "{} --reason WHY' "
                  "stores what differs from it",
                  file.string(), 1 + std::ranges::count(text.substr(0, at), '\n'),
                  suite.file.filename().string(), suite.file.string()));
}

void require_no_conflict(const std::filesystem::path& file, const Suite& suite) {
  std::ifstream input(file, std::ios::binary);
  std::string begin(512, '\0');
  input.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(input.gcount()));
  require_no_conflict(file, begin, suite);
}

}  // namespace kerf::bench
