#pragma once

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace kerf::test {

/// Where a file of measured data is, by its name as in examples/data/open-data.tsv: in the folder that
/// scripts/fetch-data fills, else in KERF_SHARED_DATA. Empty if it is in neither.
inline std::filesystem::path find_measured_file(const std::string& name) {
  for (const auto* folder : {KERF_SOURCE_DIR "/data", KERF_SHARED_DATA}) {
    auto file = std::filesystem::path(folder) / name;
    if (std::filesystem::exists(file)) return file;
  }
  return {};
}

/// Where a file is that the test has asked for by KERF_NEEDS_DATA.
inline std::filesystem::path measured_file(const std::string& name) {
  auto file = find_measured_file(name);
  if (file.empty()) throw std::runtime_error(name + " is taken without KERF_NEEDS_DATA before it");
  return file;
}

/// Why a test is left out without this file: a line that is the same for all files of its kind, then the
/// file.
inline std::string why_left_out(const std::string& name) {
  std::ifstream table(KERF_SOURCE_DIR "/examples/data/open-data.tsv");
  const std::string row = name + '\t';
  bool can_be_fetched = false;
  for (std::string line; std::getline(table, line);) can_be_fetched |= line.starts_with(row);
  return (can_be_fetched ? "measured data: scripts/fetch-data brings them\n"
                         : "measured data that no public address has as it is\n") +
         name;
}

inline std::string first_missing(std::initializer_list<std::string> names) {
  for (const auto& name : names) {
    if (find_measured_file(name).empty()) return name;
  }
  return {};
}

}  // namespace kerf::test

/// Leaves the test out, and says why, unless these files of measured data are here.
#define KERF_NEEDS_DATA(...)                                                                     \
  if (const std::string missing = ::kerf::test::first_missing({__VA_ARGS__}); missing.empty()) { \
  } else                                                                                         \
    GTEST_SKIP() << ::kerf::test::why_left_out(missing)
