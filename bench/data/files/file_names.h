#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace kerf::bench {

/// A text as the name of a file: letters, digits, '-', '.' and what is not ASCII; anything else is an
/// underscore, and so is a dot that it begins with. No more than some 100 bytes.
[[nodiscard]] std::string as_file_name(const std::string& text);

/// All files in a folder and in those within that `enters` lets in, sorted. Links to folders are not
/// followed, and stand among the files; so does a folder within that cannot be listed: whoever opens it is
/// told why.
/// @throws std::invalid_argument if there is no such folder, or it cannot be listed.
[[nodiscard]] std::vector<std::filesystem::path> files_within(
    const std::filesystem::path& folder,
    const std::function<bool(const std::filesystem::path&)>& enters = [](const auto&) { return true; });

/// Names that nobody has yet: "liver", "liver-2", "liver-3".
class NewNames {
 public:
  [[nodiscard]] std::filesystem::path take(const std::filesystem::path& wanted);

 private:
  std::set<std::filesystem::path> taken_;
};

}  // namespace kerf::bench
