#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "hdf5/h5.h"

namespace kerf::schema {

/// A file under a temporary name beside its target; removed unless it was committed.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path target);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Renames it to its target. @throws std::system_error
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
};

/// Says to other processes that this one is writing a file, for as long as it lives; the system takes it back
/// when the process dies. On file systems without locks it says nothing.
class WriteMark {
 public:
  WriteMark() = default;
  explicit WriteMark(const std::filesystem::path& file);
  WriteMark(WriteMark&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  WriteMark& operator=(WriteMark&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~WriteMark();

 private:
  int descriptor_ = -1;
};

/// Whether a living process has a WriteMark on a file.
[[nodiscard]] bool is_marked(const std::filesystem::path& file);

/// The name of a recording while it is written: NAME.partial.
[[nodiscard]] std::filesystem::path partial_name(std::filesystem::path file);

/// Makes a file longer by so many bytes that the disk then has room for. @throws std::system_error
void reserve(const std::filesystem::path& file, std::size_t bytes);

/// Waits until the file's bytes are on the disk. @throws std::system_error
void synchronise(const std::filesystem::path& file);

/// Renames a file. @throws std::system_error that names the target.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Renames a file to a name that nobody has. Returns false if somebody has it. @throws std::system_error
[[nodiscard]] bool rename_new(const std::filesystem::path& from, const std::filesystem::path& to);

/// A sentence with what a file calls its parts, which must not break the line nor drive the terminal that
/// shows it: every control character of ASCII becomes a question mark.
[[nodiscard]] std::string one_line(std::string text);

/// What a user can act on when writing `file` failed.
[[nodiscard]] std::system_error write_error(const std::filesystem::path& file, const h5::Error& error);

/// @param expected "a recording", "a session", ...
/// @throws std::invalid_argument if there is no such file, it is a folder or it may not be read: the caller
///         named it wrongly.
void require_readable(const std::filesystem::path& file, std::string_view expected);

/// @throws FormatError
void require_hdf5(const std::filesystem::path& file, std::string_view expected);

}  // namespace kerf::schema
