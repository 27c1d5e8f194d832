#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace kerf::schema {

/// The name of what this process writes until it has its final name: NAME.writing-PID, beside it.
[[nodiscard]] std::filesystem::path unfinished_name(std::filesystem::path name);

/// Whether a file or a folder has such a name, of whichever process.
[[nodiscard]] bool is_unfinished(const std::filesystem::path& place);

/// Says to other processes that this one is writing a file or filling a folder, for as long as it lives; the
/// system takes it back when the process dies. On file systems without locks it says nothing.
class WriteMark {
 public:
  WriteMark() = default;
  explicit WriteMark(const std::filesystem::path& place);
  WriteMark(WriteMark&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  WriteMark& operator=(WriteMark&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~WriteMark();

 private:
  int descriptor_ = -1;
};

/// Whether a living process has a WriteMark on a file or folder.
[[nodiscard]] bool is_marked(const std::filesystem::path& place);

/// Removes what killed runs have left in a folder under an unfinished_name(): what has no WriteMark, and no
/// process of that number is there. (A number that was given anew keeps it until that process has ended.)
/// Returns what was removed; what cannot be removed stays.
std::vector<std::filesystem::path> remove_unfinished(const std::filesystem::path& folder);

}  // namespace kerf::schema
