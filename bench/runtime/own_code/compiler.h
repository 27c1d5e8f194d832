#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::bench {

/// The file that a compiler writes before it has its name; removed with its scope.
class BuiltFile {
 public:
  /// Beside the one that it becomes, in a folder that is made.
  explicit BuiltFile(const std::filesystem::path& plugin);
  BuiltFile(const BuiltFile&) = delete;
  BuiltFile& operator=(const BuiltFile&) = delete;
  ~BuiltFile();
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// What was said of it, of `source` instead.
  [[nodiscard]] std::string of_source(std::string why, const std::filesystem::path& source) const;

 private:
  std::filesystem::path path_;
};

/// The compiler that a variable of the environment names (CC, CXX), with its options, or else the usual one.
[[nodiscard]] std::vector<std::string> compiler_named(const char* variable, const char* usual);

/// Runs it. @param name of it, for messages. @returns what it said: warnings
/// @throws std::invalid_argument with its first error; std::system_error without such a compiler
[[nodiscard]] std::string compile(const std::vector<std::string>& words, const std::filesystem::path& source,
                                  const std::string& name);

/// The folder with that header of Kerf's ("kerf/plugin.h"): `include` where Kerf is installed, or `of_tree`
/// of the tree that it was built in; both are looked for from the program upwards.
/// @throws std::invalid_argument where there is none
[[nodiscard]] std::filesystem::path headers_with(const char* header, const char* of_tree);

/// @throws std::invalid_argument for a name that is none: a to z, 0 to 9 and _, first a letter, 60 at most
void require_name(std::string_view name, std::string_view what);

/// With each %KEY% replaced.
[[nodiscard]] std::string filled_in(std::string_view text,
                                    const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace kerf::bench
