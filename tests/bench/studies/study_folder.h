#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"

namespace kerf::test {

/// A drawer of files and the study that is made of it, in a folder of their own.
class StudyFolder : public testing::Test {
 protected:
  StudyFolder() { std::filesystem::create_directory(drawer()); }
  [[nodiscard]] std::filesystem::path drawer() const { return folder_ / "drawer"; }
  [[nodiscard]] std::filesystem::path study() const { return folder_ / "S"; }
  [[nodiscard]] std::filesystem::path file() const { return study() / "study.toml"; }
  /// As a person who corrects study.toml.
  void edit(const std::string& from, const std::string& to) const { replace_in(file(), from, to); }
  [[nodiscard]] Outcome make() const {
    return run_kerf({"study", "new", drawer().string(), "--laws", "kelvin", "-o", study().string()});
  }
  Outcome run_it(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"study", "run", file().string()});
    return run_kerf(more);
  }
  /// study.json.
  [[nodiscard]] nlohmann::json found() const {
    return nlohmann::json::parse(read_text(study() / "study.json"));
  }

  TemporaryFolder folder_;
};

}  // namespace kerf::test
