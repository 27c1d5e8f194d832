#pragma once

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

#include "files/whole_file.h"
#include "laws/law_file.h"

namespace kerf::fuzz {

/// The example laws by file name, for files that name laws.
[[nodiscard]] inline const std::map<std::string, std::string>& example_laws() {
  static const auto all = [] {
    std::map<std::string, std::string> laws;
    for (const auto& entry : std::filesystem::directory_iterator(KERF_SOURCE_DIR "/examples")) {
      const std::string name = entry.path().filename();
      if (name.ends_with(".law.toml")) laws.emplace(name, bench::read_whole_file(entry.path()));
    }
    return laws;
  }();
  return all;
}

[[nodiscard]] inline std::string example_law(const std::string& file) {
  const auto found = example_laws().find(std::filesystem::path(file).filename());
  if (found == example_laws().end()) throw std::invalid_argument("there is no file " + file);
  return found->second;
}

}  // namespace kerf::fuzz
