#include "hdf5/text_heaps.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <unordered_set>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::schema {
namespace {

/// A file that is read piece by piece: a process that renders forces has its memory locked, and with it
/// whatever it maps.
class Pieces {
 public:
  explicit Pieces(const std::filesystem::path& file)
      : name_(file.string()), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) fail();
    size_ = static_cast<std::size_t>(status.st_size);
  }
  Pieces(const Pieces&) = delete;
  Pieces& operator=(const Pieces&) = delete;
  ~Pieces() { ::close(descriptor_); }

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Where a text stands at a multiple of `alignment` from `at` on; the file's size if nowhere. A stretch at
  /// a time is mapped, of which but one line a page is touched. Holes are left out: to look into one that is
  /// mapped takes a page of a file system in memory, and where that is full, the process dies of it.
  [[nodiscard]] std::size_t find_at_multiples(std::string_view text, std::size_t at,
                                              std::size_t alignment) const {
    constexpr std::size_t stretch = std::size_t{16} << 20U;
    while (at < size_) {
      at = (at + alignment - 1) / alignment * alignment;
      if (const std::size_t data = data_from(at); data != at) {
        at = data;
        continue;
      }
      const std::size_t begin = at / page * page;
      const std::size_t length = std::min(stretch, hole_from(at) - begin);
      void* const start = ::mmap(nullptr, length, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor_,
                                 static_cast<off_t>(begin));
      if (start == MAP_FAILED) fail();
      const std::string_view bytes(static_cast<const char*>(start), length);
      bool is_found = false;
      for (; !is_found && at < begin + length; at += is_found ? 0 : alignment) {
        is_found = bytes.substr(at - begin, text.size()) == text;
      }
      ::munmap(start, length);
      if (is_found) return at;
    }
    return size_;
  }

  /// Up to so many bytes, fewer at the end of the file; valid until the next call.
  std::string_view read(std::size_t at, std::size_t length) {
    buffer_.resize(std::min(length, size_ - std::min(at, size_)));
    std::size_t have = 0;
    while (have < buffer_.size()) {
      const auto got =
          ::pread(descriptor_, buffer_.data() + have, buffer_.size() - have, static_cast<off_t>(at + have));
      if (got < 0 && errno != EINTR) fail();
      if (got == 0) break;
      if (got > 0) have += static_cast<std::size_t>(got);
    }
    return std::string_view(buffer_).substr(0, have);
  }

 private:
  static constexpr std::size_t page = 4096;

  /// Where the next byte is that the file holds, from `at` on; its size if there is none.
  [[nodiscard]] std::size_t data_from(std::size_t at) const { return seek(at, SEEK_DATA); }
  [[nodiscard]] std::size_t hole_from(std::size_t at) const { return seek(at, SEEK_HOLE); }
  [[nodiscard]] std::size_t seek(std::size_t at, int what) const {
    if (at >= size_) return size_;
    const auto found = ::lseek(descriptor_, static_cast<off_t>(at), what);
    if (found < 0 && errno != ENXIO) fail();
    return found < 0 ? size_ : std::min(static_cast<std::size_t>(found), size_);
  }

  [[noreturn]] void fail() const {
    throw std::system_error(errno, std::generic_category(), name_ + ": cannot read");
  }

  std::string name_;
  int descriptor_;
  std::size_t size_ = 0;
  std::string buffer_;
};

template <typename T>
T number_at(std::string_view bytes, std::size_t at) {
  T number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

// HDF5 file format specification, III.E: after a head of 16 bytes come objects, each with a head of 16 bytes
// (index, uses, 4 bytes, length) and its content, rounded up to 8; index 0 is the free rest.
bool is_sound(std::string_view heap) {
  constexpr std::size_t head = 16;
  std::unordered_set<std::uint16_t> indices;
  std::size_t at = head;
  while (at + head <= heap.size()) {
    const auto index = number_at<std::uint16_t>(heap, at);
    const auto length = number_at<std::uint64_t>(heap, at + 8);
    const std::size_t rest = heap.size() - at;
    if (index == 0) return length == rest;
    if (length > rest - head || !indices.insert(index).second) return false;
    at += head + (static_cast<std::size_t>(length) + 7) / 8 * 8;
  }
  return at <= heap.size();
}

}  // namespace

bool are_text_heaps_sound(const std::filesystem::path& file, std::size_t alignment) {
  using namespace std::string_view_literals;
  constexpr std::string_view signature = "GCOL\1\0\0\0"sv;
  constexpr std::size_t head = 16;
  constexpr std::size_t piece = std::size_t{256} << 10U;
  Pieces pieces(file);
  for (std::size_t at = 0; at < pieces.size();) {
    if (alignment > 1) {
      at = pieces.find_at_multiples(signature, at, alignment);
      if (at >= pieces.size()) return true;
    } else {
      const auto found = pieces.read(at, piece).find(signature);
      if (found == std::string_view::npos) {
        at += piece - signature.size() + 1;  // a signature may lie across two pieces
        continue;
      }
      at += found;
    }
    const auto start = pieces.read(at, head);
    if (start.size() < head) return false;
    const auto size = number_at<std::uint64_t>(start, signature.size());
    if (size < head || size > pieces.size() - at) return false;
    const auto heap = pieces.read(at, static_cast<std::size_t>(size));
    if (heap.size() < size || !is_sound(heap)) return false;
    at += static_cast<std::size_t>(size);
  }
  return true;
}

}  // namespace kerf::schema
