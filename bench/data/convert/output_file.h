#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include <kerf/schema/final_name.h>
#include <kerf/schema/unfinished.h>

namespace kerf::bench {

/// A file that is too large to be put together in memory: written under a temporary name beside its own,
/// which it takes when it is whole. Without commit() nothing is left of it.
class UnfinishedFile {
 public:
  /// @throws std::system_error that names the file.
  explicit UnfinishedFile(std::filesystem::path name);
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile();

  /// Where it is written.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] const std::filesystem::path& name() const noexcept { return name_; }
  /// @throws as schema::take_name().
  void commit(schema::Existing existing);
  /// "cannot write NAME". @throws std::system_error always.
  [[noreturn]] void fail(int reason) const;

 private:
  std::filesystem::path name_;
  std::filesystem::path path_;
  schema::WriteMark mark_;
  bool is_committed_ = false;
};

/// One that is written byte by byte.
class OutputFile {
 public:
  /// @throws as UnfinishedFile.
  explicit OutputFile(const std::filesystem::path& name);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// @throws std::system_error that names the file, as close() does.
  void write(std::string_view bytes);
  /// Bytes written so far.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// Hands the last bytes to the system; nothing may be written after it.
  void close();
  /// After close().
  void commit(schema::Existing existing) { file_.commit(existing); }

 private:
  UnfinishedFile file_;
  std::FILE* stream_;
  std::uint64_t size_ = 0;
};

}  // namespace kerf::bench
