#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace kerf::test {

/// Calls `each(words)` for every row of an emulated device's trace below the names of its columns; `words` is
/// a stream of what stands between the commas.
template <typename F>
void for_each_row(const std::filesystem::path& trace, F each) {
  std::ifstream file(trace);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    each(words);
  }
}

}  // namespace kerf::test
