#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace kerf::bench {

/// A text as the name of a file: letters, digits, '-', '.' and what is not ASCII; anything else is an
/// underscore, and so is a dot that it begins with. No more than some 100 bytes.
[[nodiscard]] std::string as_file_name(const std::string& text);

/// Names that nobody has yet: "liver", "liver-2", "liver-3".
class NewNames {
 public:
  [[nodiscard]] std::filesystem::path take(const std::filesystem::path& wanted);

 private:
  std::set<std::filesystem::path> taken_;
};

}  // namespace kerf::bench
