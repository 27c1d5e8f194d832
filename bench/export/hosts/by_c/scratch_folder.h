#pragma once

#include <filesystem>
#include <string>

namespace kerf::bench {

/// A folder for what is of no use afterwards: removed with its scope.
class ScratchFolder {
 public:
  /// @throws std::system_error
  ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace kerf::bench
