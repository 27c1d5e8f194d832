#include "files/kept_pipe.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/core.h>
#include <unistd.h>

#include "files/named_file.h"

namespace kerf::bench {
namespace {

/// A file that has no name, and is gone with its last descriptor.
class NamelessFile {
 public:
  NamelessFile() {
    std::string name = (std::filesystem::temp_directory_path() / "kerf-pipe-XXXXXX").string();
    descriptor_ = mkstemp(name.data());
    if (descriptor_ < 0) refuse("cannot be made");
    unlink(name.c_str());
  }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;
  ~NamelessFile() { close(descriptor_); }

  void write(const char* bytes, std::size_t count) const {
    while (count > 0) {
      const ssize_t written = ::write(descriptor_, bytes, count);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) refuse("cannot be written");
      bytes += written;
      count -= static_cast<std::size_t>(written);
    }
  }
  void take_the_place_of(int descriptor) const {
    if (dup2(descriptor_, descriptor) < 0) refuse("cannot take the place of the pipe");
  }

 private:
  [[noreturn]] static void refuse(const char* why) {
    throw std::system_error(
        errno, std::generic_category(),
        fmt::format("the copy of a pipe in {} {}", std::filesystem::temp_directory_path().string(), why));
  }

  int descriptor_;
};

/// Of /dev/stdin, /dev/fd/N or /proc/self/fd/N.
int descriptor_named(const std::filesystem::path& file) {
  if (file == "/dev/stdin") return STDIN_FILENO;
  const std::string number = file.filename().string();
  int descriptor = -1;
  std::from_chars(number.data(), number.data() + number.size(), descriptor);
  return descriptor;
}

}  // namespace

void keep_pipe(const std::filesystem::path& file, std::uintmax_t at_most) {
  const NamedFile pipe(file);
  if (!pipe.is_pipe()) return;
  const NamelessFile copy;
  std::array<char, 1 << 16> piece{};
  std::uintmax_t taken = 0;
  while (const std::size_t count = pipe.read(piece.data(), piece.size())) {
    taken += count;
    if (taken > at_most)
      throw std::invalid_argument(
          fmt::format("{}: more than {} bytes; expected that at most", file.string(), at_most));
    copy.write(piece.data(), count);
  }
  copy.take_the_place_of(descriptor_named(file));
}

}  // namespace kerf::bench
