#include "text_heaps.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>
#include <unordered_set>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::schema {
namespace {

/// A file in memory while the object lives.
class Mapping {
 public:
  explicit Mapping(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (descriptor >= 0 && ::fstat(descriptor, &status) == 0 && status.st_size > 0) {
      size_ = static_cast<std::size_t>(status.st_size);
      start_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
    }
    const int reason = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (start_ == MAP_FAILED) {
      throw std::system_error(reason, std::generic_category(), file.string() + ": cannot read");
    }
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping() { ::munmap(start_, size_); }

  [[nodiscard]] std::string_view bytes() const { return {static_cast<const char*>(start_), size_}; }

 private:
  void* start_ = MAP_FAILED;
  std::size_t size_ = 0;
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

bool are_text_heaps_sound(const std::filesystem::path& file) {
  using namespace std::string_view_literals;
  constexpr std::string_view signature = "GCOL\1\0\0\0"sv;
  constexpr std::size_t head = 16;
  const Mapping mapping(file);
  const auto bytes = mapping.bytes();
  for (auto at = bytes.find(signature); at != std::string_view::npos; at = bytes.find(signature, at)) {
    const auto rest = bytes.substr(at);
    if (rest.size() < head) return false;
    const auto size = number_at<std::uint64_t>(rest, signature.size());
    if (size < head || size > rest.size() || !is_sound(rest.substr(0, static_cast<std::size_t>(size)))) {
      return false;
    }
    at += static_cast<std::size_t>(size);
  }
  return true;
}

}  // namespace kerf::schema
