#include "kerf/drivers/usb/guard.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <new>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kerf/drivers/device.h"
#include "kerf/drivers/usb/io_thread.h"
#include "usb/guard_page.h"

namespace kerf::drivers::usb {
namespace {

constexpr int start_timeout_ms = 2000;
constexpr int end_timeout_ms = 500;  // above what it needs for a device that takes nothing
constexpr std::int64_t look_ns = 10'000'000;

[[noreturn]] void refuse(std::string_view what, const std::string& guard, int error) {
  throw DeviceError(fmt::format(
      "{}: {}, which lets the motors go should this program die, does not start ({}); no force is given "
      "without it: install or build it there",
      what, guard, std::strerror(error)));
}

std::string guard_beside_program() {
  std::error_code error;
  return (std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "kerf-guard").string();
}

/// A descriptor that is closed at the end of its scope; -1: none.
class Owned {
 public:
  explicit Owned(int number) : number_(number) {}
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { reset(); }
  [[nodiscard]] int number() const { return number_; }
  int release() { return std::exchange(number_, -1); }
  void reset() {
    if (number_ >= 0) close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// Also when it ends; whatever signals come meanwhile.
bool becomes_readable(int descriptor, int timeout_ms) noexcept {
  pollfd waited{.fd = descriptor, .events = POLLIN, .revents = 0};
  int ready = poll(&waited, 1, timeout_ms);
  while (ready < 0 && errno == EINTR) ready = poll(&waited, 1, timeout_ms);
  return ready > 0;
}

/// Starts it with nothing but those descriptors, deaf to signals, in a session of its own: what ends this
/// program from outside, or its group, does not end the guard. @returns an error number; 0: it runs.
int spawn(const std::string& guard, int device, int program, int page, pid_t& process) {
  // Above where they are put, so that none is overwritten before it is duplicated.
  constexpr int above = 16;
  const Owned high_device(fcntl(device, F_DUPFD_CLOEXEC, above));
  const Owned high_program(fcntl(program, F_DUPFD_CLOEXEC, above));
  const Owned high_page(fcntl(page, F_DUPFD_CLOEXEC, above));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int standard : {0, 1, 2}) {
    posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
  }
  posix_spawn_file_actions_adddup2(&actions, high_device.number(), guard_of_device);
  posix_spawn_file_actions_adddup2(&actions, high_program.number(), guard_to_program);
  posix_spawn_file_actions_adddup2(&actions, high_page.number(), guard_of_page);
  posix_spawn_file_actions_addclosefrom_np(&actions, guard_of_page + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t every;
  sigfillset(&every);
  posix_spawnattr_setsigmask(&attributes, &every);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  std::string name = "kerf-guard";
  std::array<char*, 2> arguments{name.data(), nullptr};
  const int error = posix_spawn(&process, guard.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

Guard::Guard(std::string_view what, int descriptor, const LettingGo& letting_go) {
  const std::string guard = guard_beside_program();
  const Owned page(memfd_create("kerf-guard", MFD_CLOEXEC));
  if (page.number() < 0 || ftruncate(page.number(), sizeof(GuardPage)) != 0) refuse(what, guard, errno);
  std::array<int, 2> ends{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) refuse(what, guard, errno);
  Owned program(ends[0]);
  Owned its_own(ends[1]);
  void* const mapped = mmap(nullptr, sizeof(GuardPage), PROT_READ | PROT_WRITE, MAP_SHARED, page.number(), 0);
  if (mapped == MAP_FAILED) refuse(what, guard, errno);
  page_ = new (mapped) GuardPage{.letting_go = letting_go};
  if (const int error = spawn(guard, descriptor, its_own.number(), page.number(), process_); error != 0) {
    process_ = 0;
    end();
    refuse(what, guard, error);
  }
  // Its own end only it may hold: then the stream ends when it does.
  its_own.reset();
  socket_ = program.release();
  char said = 0;
  const bool spoke = becomes_readable(socket_, start_timeout_ms);
  if (!spoke || recv(socket_, &said, 1, MSG_DONTWAIT) != 1 || said != guard_is_ready) {
    end();
    refuse(what, guard, spoke ? ECONNRESET : ETIMEDOUT);
  }
  lives_.store(true);
}

Guard::~Guard() { end(); }

void Guard::end() noexcept {
  if (socket_ >= 0 && process_ > 0) {
    // Where the last force did not end the guard shall end it, as if this program were dead.
    if (page_->until_ns.load() == 0) (void)send(socket_, &guard_may_go, 1, MSG_NOSIGNAL);
    (void)shutdown(socket_, SHUT_WR);
    // Somebody may have stopped it.
    if (!becomes_readable(socket_, end_timeout_ms)) (void)kill(process_, SIGKILL);
  }
  if (socket_ >= 0) close(socket_);
  while (process_ > 0 && waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (page_ != nullptr) munmap(page_, sizeof(GuardPage));
}

void Guard::hold_until(std::int64_t until_ns) noexcept {
  page_->until_ns.store(until_ns, std::memory_order_release);
  const std::int64_t now = now_ns();
  if (now - looked_ns_ < look_ns) return;
  looked_ns_ = now;
  char nothing = 0;
  // It says nothing more: what there is to read is its end.
  const auto got = recv(socket_, &nothing, 1, MSG_PEEK | MSG_DONTWAIT);
  const bool waits = got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
  if (!waits) lives_.store(false, std::memory_order_relaxed);
}

}  // namespace kerf::drivers::usb
