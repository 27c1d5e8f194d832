#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace kerf::bench {

/// A file's content in memory, mapped for reading while the object lives.
class MappedFile {
 public:
  /// @throws as NamedFile does, and for what is no regular file; std::system_error if it cannot be mapped.
  explicit MappedFile(const std::filesystem::path& file);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  [[nodiscard]] std::string_view text() const noexcept { return {static_cast<const char*>(begin_), size_}; }

 private:
  void* begin_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace kerf::bench
