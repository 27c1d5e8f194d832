#include "regress/renderers/run_program.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t words_kept = 4096;  ///< bytes of each stream
constexpr int look_every_ms = 10;         ///< at the size of what it writes

/// A descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) noexcept : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { reset(); }
  [[nodiscard]] int number() const noexcept { return number_; }
  void reset() noexcept {
    if (number_ >= 0) close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

std::array<int, 2> new_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
  return ends;
}

/// One of its streams, of which the end is kept.
class Stream {
 public:
  Stream() : Stream(new_pipe()) {}
  explicit Stream(const std::array<int, 2>& ends) : ours(ends[0]), theirs(ends[1]) {
    fcntl(ours.number(), F_SETFL, O_NONBLOCK);  // a process that has left may hold the other end for ever
  }
  /// Takes what is there; false at its end.
  bool take() {
    std::array<char, 16384> buffer{};
    const ssize_t count = read(ours.number(), buffer.data(), buffer.size());
    if (count <= 0) return count < 0 && (errno == EAGAIN || errno == EINTR);
    said.append(buffer.data(), static_cast<std::size_t>(count));
    if (said.size() > 2 * words_kept) said.erase(0, said.size() - words_kept);
    return true;
  }
  /// What is still in the pipe, and no more: whoever holds the other end may go on writing.
  void take_rest() {
    for (std::size_t before = said.size() + 1, rounds = 0; before != said.size() && rounds < 64; ++rounds) {
      before = said.size();
      if (!take()) return;
    }
  }
  Descriptor ours;
  Descriptor theirs;
  std::string said{};
};

pid_t spawn(const ProgramRun& run, const Stream& output, const Stream& errors) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.theirs.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.theirs.number(), STDERR_FILENO);
  if (!run.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, run.folder.c_str());
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t standard;
  sigemptyset(&standard);
  posix_spawnattr_setsigmask(&attributes, &standard);
  sigaddset(&standard, SIGPIPE);  // which this program ignores
  posix_spawnattr_setsigdefault(&attributes, &standard);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> words = run.command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw std::invalid_argument(fmt::format("the renderer '{}' cannot be started: {}", run.command.front(),
                                            std::generic_category().message(error)));
  }
  return process;
}

/// The last line that it said, as the end of a message.
std::string last_words(const Stream& output, const Stream& errors) {
  std::string said = errors.said.empty() ? output.said : errors.said;
  said.erase(said.find_last_not_of(" \t\r\n") + 1);
  const std::string line = said.substr(said.find_last_of('\n') + 1, 300);
  return line.empty() ? "; it said nothing" : fmt::format("; it said last: {}", line);
}

void require_end(int status, const std::string& said) {
  if (WIFSIGNALED(status)) {
    const char* const name = sigabbrev_np(WTERMSIG(status));
    throw std::invalid_argument(fmt::format("the renderer was ended by signal {} (SIG{}){}", WTERMSIG(status),
                                            name == nullptr ? "?" : name, said));
  }
  if (WEXITSTATUS(status) != 0) {
    throw std::invalid_argument(
        fmt::format("the renderer ended with status {}, expected 0{}", WEXITSTATUS(status), said));
  }
}

bool too_large(const ProgramRun& run) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(run.output, none);
  return !none && size > run.output_at_most;
}

/// Why it has to be killed; empty: it ended.
std::string watch(const ProgramRun& run, pid_t process, Stream& output, Stream& errors) {
  const Descriptor end(static_cast<int>(syscall(SYS_pidfd_open, process, 0)));
  if (end.number() < 0) throw std::system_error(errno, std::generic_category(), "a process to wait for");
  const auto deadline = Clock::now() + run.timeout;
  std::array<pollfd, 3> waited{{{.fd = end.number(), .events = POLLIN, .revents = 0},
                                {.fd = output.ours.number(), .events = POLLIN, .revents = 0},
                                {.fd = errors.ours.number(), .events = POLLIN, .revents = 0}}};
  for (;;) {
    poll(waited.data(), waited.size(), look_every_ms);
    if (waited[1].revents != 0 && !output.take()) waited[1].fd = -1;
    if (waited[2].revents != 0 && !errors.take()) waited[2].fd = -1;
    if (too_large(run)) {
      return fmt::format(
          "the renderer wrote more than {} bytes of forces, more than its rows can take, and was killed",
          run.output_at_most);
    }
    if (waited[0].revents != 0) return {};
    if (Clock::now() > deadline) {
      return fmt::format("the renderer had not ended after {:g} s and was killed with its process group",
                         run.timeout.count());
    }
  }
}

}  // namespace

ProgramWords run_program(const ProgramRun& run) {
  Stream output;
  Stream errors;
  const pid_t process = spawn(run, output, errors);
  output.theirs.reset();
  errors.theirs.reset();
  std::string why;
  std::exception_ptr failed;
  try {
    why = watch(run, process, output, errors);
  } catch (...) {
    failed = std::current_exception();
  }
  // Its group is there as long as it has not been waited for: no other process can have the number.
  kill(-process, SIGKILL);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (failed) std::rethrow_exception(failed);
  output.take_rest();
  errors.take_rest();
  if (!why.empty()) throw std::invalid_argument(why + last_words(output, errors));
  require_end(status, last_words(output, errors));
  return {.output = std::move(output.said), .errors = std::move(errors.said)};
}

}  // namespace kerf::bench
