#include "regress/renderers/child_program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "files/for_terminal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t words_kept = 4096;  ///< bytes of each stream
constexpr int lines_kept = 20;
constexpr std::size_t longest_in_print = 300;
constexpr std::size_t most_others = 2;  ///< to wait for beside a program

using Clock = std::chrono::steady_clock;

int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 60'000));
}

pid_t spawn(const ChildProgram::Start& start, const Descriptor& output, const Descriptor& errors) {
  pid_t process = 0;
  const int error = processes::start({.words = start.command,
                                      .folder = start.folder,
                                      .input = start.input,
                                      .output = start.output < 0 ? output.number() : start.output,
                                      .errors = errors.number(),
                                      .has_group = true},
                                     process);
  if (error != 0) {
    throw std::invalid_argument(fmt::format("the renderer '{}' cannot be started: {}", start.command.front(),
                                            std::generic_category().message(error)));
  }
  return process;
}

}  // namespace

Pipe::Pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
  reads = Descriptor(ends[0]);
  writes = Descriptor(ends[1]);
}

SaidStream::SaidStream() {
  fcntl(pipe_.reads.number(), F_SETFL, O_NONBLOCK);  // who has left the group may hold the other end for ever
}

bool SaidStream::take() {
  std::array<char, 16384> buffer{};
  const ssize_t count = read(pipe_.reads.number(), buffer.data(), buffer.size());
  if (count <= 0) return count < 0 && (errno == EAGAIN || errno == EINTR);
  said_.append(buffer.data(), static_cast<std::size_t>(count));
  if (said_.size() > 2 * words_kept) said_.erase(0, said_.size() - words_kept);
  return true;
}

void SaidStream::take_rest() {
  for (std::size_t before = said_.size() + 1, rounds = 0; before != said_.size() && rounds < 64; ++rounds) {
    before = said_.size();
    if (!take()) return;
  }
}

ChildProgram::ChildProgram(const Start& start)
    : process_(spawn(start, output.pipe().writes, errors.pipe().writes)),
      ended_(static_cast<int>(syscall(SYS_pidfd_open, process_, 0))) {
  const int error = errno;
  output.pipe().writes.reset();
  errors.pipe().writes.reset();
  if (ended_.number() >= 0) return;
  kill_group();
  throw std::system_error(error, std::generic_category(), "a process to wait for");
}

ChildProgram::~ChildProgram() { kill_group(); }

bool ChildProgram::wait(std::span<pollfd> others, Clock::time_point deadline) {
  std::array<pollfd, most_others + 3> waited{};
  for (;;) {
    std::ranges::copy(others, waited.begin());
    pollfd* const own = waited.data() + others.size();
    own[0] = {.fd = ended_.number(), .events = POLLIN, .revents = 0};
    own[1] = {.fd = output.pipe().reads.number(), .events = POLLIN, .revents = 0};
    own[2] = {.fd = errors.pipe().reads.number(), .events = POLLIN, .revents = 0};
    poll(waited.data(), others.size() + 3, milliseconds_until(deadline));
    if (own[1].revents != 0 && !output.take()) output.pipe().reads.reset();
    if (own[2].revents != 0 && !errors.take()) errors.pipe().reads.reset();
    std::copy_n(waited.begin(), others.size(), others.begin());
    const bool is_ready = std::ranges::any_of(others, [](const pollfd& one) { return one.revents != 0; });
    // Who floods its streams is not waited for longer than the others.
    if (is_ready || own[0].revents != 0 || Clock::now() >= deadline) return own[0].revents != 0;
  }
}

int ChildProgram::kill_group() noexcept {
  if (reaped_) return status_;
  // The group is there as long as its first process has not been waited for: no other can have the number.
  kill(-process_, SIGKILL);
  while (waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
  }
  reaped_ = true;
  try {
    output.take_rest();
    errors.take_rest();
  } catch (const std::bad_alloc&) {  // its last words are lost, and nothing else
  }
  return status_;
}

std::string ChildProgram::last_words() const {
  std::string said = errors.said().empty() ? output.said() : errors.said();
  said.erase(said.find_last_not_of(" \t\r\n") + 1);
  const std::string line = in_print(std::string_view(said).substr(said.find_last_of('\n') + 1));
  return line.empty() ? "; it said nothing" : fmt::format("; it said last: {}", line);
}

std::string last_lines(std::string_view said) {
  said = said.substr(0, said.find_last_not_of(" \t\r\n") + 1);
  std::string lines;
  for (int count = 0; count < lines_kept && !said.empty(); ++count) {
    const auto end = said.find_last_of('\n');
    lines.insert(0, in_print(end == std::string_view::npos ? said : said.substr(end + 1)) + '\n');
    said = said.substr(0, end == std::string_view::npos ? 0 : end);
  }
  return lines;
}

std::string in_print(std::string_view said) {
  std::string text(said.substr(0, longest_in_print));
  const auto is_control = [](char letter) {
    return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
  };
  std::ranges::replace_if(text, is_control, ' ');
  text.erase(0, text.find_first_not_of(' '));
  return for_terminal(text);
}

std::string end_in_words(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("ended with status {}", WEXITSTATUS(status));
  const char* const name = sigabbrev_np(WTERMSIG(status));
  return fmt::format("was ended by signal {} (SIG{})", WTERMSIG(status), name == nullptr ? "?" : name);
}

}  // namespace kerf::bench
