#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include <kerf/schema/final_name.h>
#include <kerf/schema/unfinished.h>

#include "hdf5/h5.h"

namespace kerf::schema {

/// A file under a temporary name beside its target; removed unless it was committed.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path target);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  /// Begins the file. @throws h5::Error
  [[nodiscard]] h5::WritableFile create(
      h5::WritableFile::Format format = h5::WritableFile::Format::oldest_readers);
  /// Gives it the name of its target. @throws as take_name() does.
  void commit(Existing existing);

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  WriteMark mark_;
};

/// The name of a recording while it is written: NAME.partial.
[[nodiscard]] std::filesystem::path partial_name(std::filesystem::path file);

/// Makes a file longer by so many bytes that the disk then has room for. @throws std::system_error
void reserve(const std::filesystem::path& file, std::size_t bytes);

/// The folder that a file stands in.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& file);

/// Waits until the file's bytes, or the names in a folder, are on the disk. @throws std::system_error
void synchronise(const std::filesystem::path& file);
/// The same of what can be read of a file, and not of its times: while it grows.
void synchronise_data(const std::filesystem::path& file);

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
