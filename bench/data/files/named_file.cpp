#include "files/named_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/memory_room.h"

namespace kerf::bench {
namespace {

constexpr std::uintmax_t worth_asking = std::uintmax_t{1} << 20U;  ///< for memory [bytes]

[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view why) {
  throw std::invalid_argument(fmt::format("{}: {}", file.string(), why));
}

[[noreturn]] void refuse_unreadable(const std::filesystem::path& file) {
  refuse(file, fmt::format("cannot be read: {}", std::strerror(errno)));
}

/// A name for what this process has open already: nobody meets a pipe there by chance.
bool is_handed_over(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  return file == "/dev/stdin" || folder == "/dev/fd" || folder == "/proc/self/fd";
}

std::string_view why_unfit(mode_t mode, bool handed_over) {
  if (S_ISREG(mode) || (handed_over && S_ISFIFO(mode))) return {};
  if (S_ISDIR(mode)) return "a folder; expected a file";
  if (S_ISFIFO(mode))
    return "a FIFO; expected a regular file, or a pipe handed over as /dev/stdin or <(command)";
  return "a device; expected a regular file";
}

std::string in_words(std::uintmax_t bytes) {
  if (bytes >> 20U == 0) return fmt::format("{} bytes", bytes);
  return bytes >> 30U > 0 ? fmt::format("{} GiB", bytes >> 30U) : fmt::format("{} MiB", bytes >> 20U);
}

}  // namespace

// Without O_NONBLOCK a FIFO is waited for until somebody writes to it; O_NOCTTY lets no terminal become ours.
NamedFile::NamedFile(const std::filesystem::path& file, std::chrono::milliseconds silence)
    : file_(file),
      longest_silence_(silence),
      descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
  if (descriptor_ < 0 && errno == ENOENT) refuse(file, "no such file");
  if (descriptor_ < 0) refuse_unreadable(file);
  struct stat facts {};
  const bool known = fstat(descriptor_, &facts) == 0;
  if (const auto why = known ? why_unfit(facts.st_mode, is_handed_over(file)) : std::strerror(errno);
      !why.empty()) {
    close(descriptor_);
    refuse(file, why);
  }
  is_pipe_ = !S_ISREG(facts.st_mode);
  if (!is_pipe_) size_ = static_cast<std::uintmax_t>(facts.st_size);
}

NamedFile::~NamedFile() { close(descriptor_); }

void NamedFile::wait_for_a_writer() const {
  pollfd pipe{.fd = descriptor_, .events = POLLIN, .revents = 0};
  int ready = 0;
  do {
    ready = poll(&pipe, 1, static_cast<int>(longest_silence_.count()));
  } while (ready < 0 && errno == EINTR);
  if (ready == 0)
    refuse(file_, fmt::format("nothing came through the pipe for {:g} s; is its writer at work?",
                              std::chrono::duration<double>(longest_silence_).count()));
}

std::size_t NamedFile::read(void* bytes, std::size_t room) const {
  for (;;) {
    const ssize_t count = ::read(descriptor_, bytes, room);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EAGAIN) {
      wait_for_a_writer();
    } else if (errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), "cannot read " + file_.string());
    }
  }
}

void NamedFile::require_at_most(std::uintmax_t bytes) const {
  if (size_ > bytes) refuse(file_, fmt::format("{} bytes; expected {} at most", size_, in_words(bytes)));
}

std::string NamedFile::read_all(std::uintmax_t at_most) const {
  require_at_most(at_most);
  if (size_ > worth_asking) require_memory(file_, size_, "its text");
  std::string content;
  std::array<char, 1 << 16> piece{};
  while (const std::size_t count = read(piece.data(), piece.size())) {
    if (content.size() + count > at_most)
      refuse(file_, fmt::format("more than {}; expected that at most", in_words(at_most)));
    content.append(piece.data(), count);
  }
  return content;
}

std::string read_named_file(const std::filesystem::path& file, std::uintmax_t at_most) {
  return NamedFile(file).read_all(at_most);
}

void require_named_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) refuse(folder, "there is no such folder");
  if (faccessat(AT_FDCWD, folder.c_str(), R_OK | X_OK, AT_EACCESS) != 0) refuse_unreadable(folder);
}

}  // namespace kerf::bench
