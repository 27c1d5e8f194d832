#include "kerf/drivers/usb/guard.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <string>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <kerf/processes/helper.h>

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

}  // namespace

Guard::Guard(std::string_view what, int descriptor, const LettingGo& letting_go) {
  const std::string guard = processes::helper_program("kerf-guard");
  const processes::Descriptor page(memfd_create("kerf-guard", MFD_CLOEXEC));
  if (page.number() < 0 || ftruncate(page.number(), sizeof(GuardPage)) != 0) refuse(what, guard, errno);
  auto [program, its_own] = processes::connection(SOCK_STREAM);
  if (program.number() < 0) refuse(what, guard, errno);
  void* const mapped = mmap(nullptr, sizeof(GuardPage), PROT_READ | PROT_WRITE, MAP_SHARED, page.number(), 0);
  if (mapped == MAP_FAILED) refuse(what, guard, errno);
  page_ = new (mapped) GuardPage{.letting_go = letting_go};
  const std::array descriptors{descriptor, its_own.number(), page.number()};
  if (const int error = processes::start(guard, descriptors, process_); error != 0) {
    process_ = 0;
    end();
    refuse(what, guard, error);
  }
  // Its own end only it may hold: then the stream ends when it does.
  its_own.reset();
  socket_ = program.release();
  char said = 0;
  const bool spoke = processes::becomes_readable(socket_, start_timeout_ms);
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
    if (!processes::becomes_readable(socket_, end_timeout_ms)) (void)kill(process_, SIGKILL);
  }
  if (socket_ >= 0) close(socket_);
  if (process_ > 0) processes::wait_for(process_);
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
