#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kerf::bench {

/// What tells a file from any other, and from itself before it was changed, without reading it.
struct FileFacts {
  std::uint64_t inode = 0;
  std::uint64_t size = 0;
  std::int64_t changed_ns = 0;  ///< since 1970

  /// @throws std::system_error that names the file.
  [[nodiscard]] static FileFacts of(const std::filesystem::path& file);
  friend bool operator==(const FileFacts&, const FileFacts&) = default;
};

/// Keeps on the disk what was made of a recording to look at it, so that it is not made again: one file a
/// part, never changed once it is there. Whatever is wrong with it counts as not being there; what cannot be
/// kept is not kept, without a word. Above its size the parts that were not used for longest go.
class ViewCache {
 public:
  static constexpr std::uintmax_t usual_most_bytes = std::uintmax_t{2} << 30U;

  /// $XDG_CACHE_HOME/kerf/pyramids, else that in ~/.cache; empty where there is neither.
  [[nodiscard]] static std::filesystem::path usual_folder();

  /// An empty folder: nothing is kept.
  explicit ViewCache(std::filesystem::path folder, std::uintmax_t max_bytes = usual_most_bytes);

  /// A part as it was kept; its bytes lie aligned for any number.
  struct Part {
    std::string uuid;  ///< of the recording
    std::uint64_t rows = 0;
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> owner;  ///< keeps the bytes
  };
  [[nodiscard]] std::optional<Part> find(const FileFacts& recording, std::string_view name) const;
  void keep(const FileFacts& recording, std::string_view name, const Part& part) const;

 private:
  [[nodiscard]] std::filesystem::path file_of(const FileFacts& recording, std::string_view name) const;
  void remove_oldest() const;

  std::filesystem::path folder_;
  std::uintmax_t max_bytes_;
};

}  // namespace kerf::bench
