#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace kerf::bench {

struct WatchedMapping;

/// A file's content in memory while the object lives: mapped for reading, or read where it is a pipe. What
/// cannot be read any more, because somebody makes the file shorter or its disk fails, is zeros; to the first
/// mapping of a process a handler of SIGBUS belongs, which passes on what is none of theirs.
class MappedFile {
 public:
  /// @throws as NamedFile does, and for what holds more than `at_most` bytes; std::system_error if it cannot
  ///         be mapped.
  explicit MappedFile(const std::filesystem::path& file,
                      std::uintmax_t at_most = std::numeric_limits<std::uintmax_t>::max());
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  [[nodiscard]] std::string_view text() const noexcept {
    return begin_ == nullptr ? std::string_view(piped_)
                             : std::string_view(static_cast<const char*>(begin_), size_);
  }
  /// For whoever has read what they wanted: it was what the file holds.
  /// @throws std::invalid_argument with its name if a part of it could not be read any more.
  void require_whole() const;
  /// Lets go of the memory of a part that has been looked at, of text(); it is read again where it is asked
  /// for.
  void let_go_of(std::string_view part) const noexcept;

 private:
  std::filesystem::path file_;
  void* begin_ = nullptr;
  std::size_t size_ = 0;
  WatchedMapping* watched_ = nullptr;
  std::string piped_;
};

}  // namespace kerf::bench
