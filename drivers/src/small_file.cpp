#include "small_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::drivers {
namespace {

/// Of a file that is open.
std::string problem_of(int descriptor, std::size_t at_most) {
  struct stat facts {};
  if (fstat(descriptor, &facts) != 0) return std::strerror(errno);
  if (S_ISDIR(facts.st_mode)) return std::strerror(EISDIR);
  if (!S_ISREG(facts.st_mode)) return "not a regular file";
  if (static_cast<std::size_t>(facts.st_size) > at_most)
    return fmt::format("{} bytes, expected {} at most", facts.st_size, at_most);
  return {};
}

/// May be less than `at_most` bytes where the file ends before.
SmallFile content_of(int descriptor, std::size_t at_most) {
  SmallFile file{.content = std::string(at_most, '\0'), .problem = {}};
  std::size_t size = 0;
  while (size < at_most) {
    const ssize_t count = read(descriptor, file.content.data() + size, at_most - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return {.content = {}, .problem = std::strerror(errno)};
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  file.content.resize(size);
  return file;
}

}  // namespace

SmallFile read_small_file(const std::string& path, std::size_t at_most) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return {.content = {}, .problem = std::strerror(errno)};
  SmallFile file{.content = {}, .problem = problem_of(descriptor, at_most)};
  if (file.problem.empty()) file = content_of(descriptor, at_most);
  close(descriptor);
  return file;
}

}  // namespace kerf::drivers
