#include "intake/import_process.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <optional>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/processes/helper.h>

namespace kerf::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto import_patience = std::chrono::seconds(5);  // between being asked to stop and being killed
constexpr int look_again_ms = 100;

struct ProgressPipe {
  processes::Descriptor from;
  processes::Descriptor to;

  ProgressPipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
    from = processes::Descriptor(ends[0]);
    to = processes::Descriptor(ends[1]);
    (void)fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }
};

/// What posix_spawn() is to do with files and signals.
class SpawnOrder {
 public:
  SpawnOrder(const ImportProcess& process, int progress) {
    posix_spawn_file_actions_init(&actions_);
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, process.output.c_str(), flags, 0644);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, process.errors.c_str(), flags, 0644);
    posix_spawn_file_actions_adddup2(&actions_, progress, processes::first_descriptor);
    posix_spawn_file_actions_addclosefrom_np(&actions_, processes::first_descriptor + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  }
  SpawnOrder(const SpawnOrder&) = delete;
  SpawnOrder& operator=(const SpawnOrder&) = delete;
  ~SpawnOrder() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&actions_);
  }

  [[nodiscard]] pid_t start(const ImportProcess& process) const {
    std::vector<std::string> texts{process.program.string()};
    texts.insert(texts.end(), process.words.begin(), process.words.end());
    std::vector<std::string> settings;
    for (char** one = environ; *one != nullptr; ++one) settings.emplace_back(*one);
    settings.push_back(fmt::format("KERF_PROGRESS_FD={}", processes::first_descriptor));
    pid_t child = 0;
    const int error = posix_spawn(&child, process.program.c_str(), &actions_, &attributes_,
                                  pointers_to(texts).data(), pointers_to(settings).data());
    if (error != 0) throw std::system_error(error, std::generic_category(), process.program.string());
    return child;
  }

 private:
  static std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
  }

  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// Whole lines "DONE OF" of what has come.
void hear(int descriptor, std::string& text, const std::function<void(std::size_t, std::size_t)>& told) {
  std::array<char, 4096> buffer{};
  for (ssize_t got = 0; (got = read(descriptor, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(got));
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    std::size_t done = 0;
    std::size_t of = 0;
    const char* const last = text.data() + end;
    const auto first = std::from_chars(text.data(), last, done);
    if (first.ec == std::errc() && first.ptr < last &&
        std::from_chars(first.ptr + 1, last, of).ec == std::errc())
      told(done, of);
    text.erase(0, end + 1);
  }
}

}  // namespace

int run_import(const ImportProcess& process, const std::atomic<bool>& stop,
               const std::function<void(std::size_t, std::size_t)>& told) {
  ProgressPipe pipe;
  const pid_t child = SpawnOrder(process, pipe.to.number()).start(process);
  pipe.to.reset();
  std::optional<Clock::time_point> asked;
  std::string text;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) != child) {
    pollfd wanted{.fd = pipe.from.number(), .events = POLLIN, .revents = 0};
    (void)poll(&wanted, 1, look_again_ms);
    if ((wanted.revents & POLLHUP) != 0) (void)poll(nullptr, 0, look_again_ms / 10);  // it is about to end
    hear(pipe.from.number(), text, told);
    if (!stop) continue;
    if (!asked) {
      asked = Clock::now();
      kill(-child, SIGINT);
    } else if (Clock::now() - *asked > import_patience) {
      kill(-child, SIGKILL);
    }
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace kerf::bench
