#pragma once

#include <filesystem>
#include <string>

namespace kerf::bench {

/// A file that somebody named as input, or a pipe, open for reading. One that cannot be opened was named
/// wrongly, which is bad input; what fails later is a system error.
class NamedFile {
 public:
  /// @throws std::invalid_argument with its name: missing, a folder, not to be read.
  explicit NamedFile(const std::filesystem::path& file);
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;
  ~NamedFile();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

/// All that can be read of a NamedFile. @throws as it does; std::system_error.
[[nodiscard]] std::string read_named_file(const std::filesystem::path& file);

/// @throws std::invalid_argument if there is no such folder, or its files cannot be listed.
void require_named_folder(const std::filesystem::path& folder);

}  // namespace kerf::bench
