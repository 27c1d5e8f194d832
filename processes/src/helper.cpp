#include "kerf/processes/helper.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kerf::processes {

void Descriptor::reset() noexcept {
  if (number_ >= 0) close(number_);
  number_ = -1;
}

Connection connection(int type) noexcept {
  std::array<int, 2> ends{-1, -1};
  if (socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, ends.data()) != 0) return {};
  return {.ours = Descriptor(ends[0]), .theirs = Descriptor(ends[1])};
}

namespace {

std::filesystem::path& told_folder() {
  static std::filesystem::path folder;
  return folder;
}

}  // namespace

void look_for_helpers_in(std::filesystem::path folder) { told_folder() = std::move(folder); }

std::filesystem::path helper_program(std::string_view name) {
  if (!told_folder().empty()) return told_folder() / name;
  std::error_code error;
  const auto programs = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const auto helpers = (programs / KERF_HELPERS_FROM_PROGRAMS).lexically_normal();
  return (std::filesystem::is_directory(helpers, error) ? helpers : programs) / name;
}

int start(const std::filesystem::path& program, std::span<const int> descriptors, pid_t& process,
          std::span<const std::string> arguments) {
  // Above where they are put, so that none is overwritten before it is duplicated.
  const int above = first_descriptor + static_cast<int>(descriptors.size());
  std::vector<Descriptor> high;
  for (const int descriptor : descriptors) {
    high.emplace_back(fcntl(descriptor, F_DUPFD_CLOEXEC, above));
    if (high.back().number() < 0) return errno;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  // A helper without one of its descriptors would take what it does for done: it is not started.
  int not_added = 0;
  const auto add = [&](int result) {
    if (not_added == 0) not_added = result;
  };
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    add(posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0));
  }
  int place = first_descriptor;
  for (const Descriptor& descriptor : high) {
    add(posix_spawn_file_actions_adddup2(&actions, descriptor.number(), place++));
  }
  add(posix_spawn_file_actions_addclosefrom_np(&actions, place));
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t every;
  sigfillset(&every);
  posix_spawnattr_setsigmask(&attributes, &every);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  std::vector<std::string> words{program.filename().string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> command;
  for (std::string& word : words) command.push_back(word.data());
  command.push_back(nullptr);
  const int error =
      not_added != 0 ? not_added
                     : posix_spawn(&process, program.c_str(), &actions, &attributes, command.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

int wait_for(pid_t process) noexcept {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

bool becomes_readable(int descriptor, int timeout_ms) noexcept {
  using std::chrono::steady_clock;
  const auto end = steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  pollfd waited{.fd = descriptor, .events = POLLIN, .revents = 0};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - steady_clock::now()).count();
    const int ready = poll(&waited, 1, left > 0 ? static_cast<int>(left) : 0);
    if (ready >= 0 || errno != EINTR) return ready > 0;
  }
}

}  // namespace kerf::processes
