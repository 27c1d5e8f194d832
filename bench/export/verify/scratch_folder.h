#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kerf::bench {

/// A folder below the system's for temporary files, for what is of no use afterwards: removed with its scope.
class ScratchFolder {
 public:
  /// @throws std::system_error
  ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Writes a file into it, with the folders in between. @throws std::system_error
  void write(const std::filesystem::path& name, std::string_view content) const;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace kerf::bench
