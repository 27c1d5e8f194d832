// kerf-guard: lets a device's motors go when the program that holds them dies or hangs. Started by the driver
// (usb/guard.h) with all signals blocked, in a session of its own. Takes no memory once it has said that it
// is ready.

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "usb/guard_page.h"

namespace {

using namespace kerf::drivers;
using namespace kerf::drivers::usb;

constexpr unsigned transfer_ms = 10;
constexpr std::int64_t look_ns = 10'000'000;

std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

/// Each as far as it is permitted: more urgent than the loop (79) and, for root, the thread of the device
/// (80), off the loop's processor, which is the last, not to be swapped out, nor to be chosen when memory is
/// short.
void be_prompt() noexcept {
  constexpr int priority = 81;
  rlimit permitted{};
  getrlimit(RLIMIT_RTPRIO, &permitted);
  for (const int wanted : {priority, static_cast<int>(std::min<rlim_t>(priority, permitted.rlim_cur))}) {
    const sched_param parameters{.sched_priority = wanted};
    if (sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) break;
  }
  cpu_set_t processors;
  CPU_ZERO(&processors);
  if (sched_getaffinity(0, sizeof processors, &processors) == 0 && CPU_COUNT(&processors) > 1) {
    int last = CPU_SETSIZE - 1;
    while (!CPU_ISSET(last, &processors)) --last;
    CPU_CLR(last, &processors);
    (void)sched_setaffinity(0, sizeof processors, &processors);
  }
  prctl(PR_SET_TIMERSLACK, 1UL);
  (void)mlockall(MCL_CURRENT | MCL_FUTURE);
  const int spared = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (spared >= 0) {
    [[maybe_unused]] const auto written = write(spared, "-1000", 5);
    close(spared);
  }
}

/// Sends all of it, whatever fails. False where the device is gone.
bool let_go(LettingGo& what) noexcept {
  for (unsigned round = 0; round < what.rounds; ++round) {
    for (unsigned at = 0; at < what.count; ++at) {
      LettingGo::Transfer& one = what.transfers[at];
      // The kernel takes it for endpoints of both kinds, bulk and interrupt.
      usbdevfs_bulktransfer transfer{
          .ep = one.endpoint, .len = one.size, .timeout = transfer_ms, .data = one.bytes.data()};
      if (ioctl(guard_of_device, USBDEVFS_BULK, &transfer) >= 0) continue;
      if (errno == ENODEV) return false;
      unsigned endpoint = one.endpoint;
      if (errno == EPIPE) (void)ioctl(guard_of_device, USBDEVFS_CLEAR_HALT, &endpoint);
    }
  }
  return true;
}

/// Until the program says goodbye or is gone. @returns whether it said so.
bool watch(const GuardPage& page, LettingGo& letting_go) noexcept {
  std::int64_t done_for_ns = 0;  // let go once for each time that ran out: the program may come back
  while (true) {
    const std::int64_t until_ns = page.until_ns.load(std::memory_order_acquire);
    const bool held = until_ns != 0 && until_ns != done_for_ns;
    const std::int64_t wait_ns = held ? std::clamp<std::int64_t>(until_ns - now_ns(), 0, look_ns) : look_ns;
    const timespec wait{.tv_sec = 0, .tv_nsec = wait_ns};
    pollfd program{.fd = guard_to_program, .events = POLLIN, .revents = 0};
    if (ppoll(&program, 1, &wait, nullptr) > 0) {
      char said = 0;
      return recv(guard_to_program, &said, 1, 0) == 1 && said == guard_may_go;
    }
    if (held && page.until_ns.load(std::memory_order_acquire) == until_ns && now_ns() >= until_ns) {
      (void)let_go(letting_go);
      done_for_ns = until_ns;
    }
  }
}

}  // namespace

int main() {
  void* const mapped = mmap(nullptr, sizeof(GuardPage), PROT_READ, MAP_SHARED, guard_of_page, 0);
  if (mapped == MAP_FAILED) return 1;
  const auto& page = *static_cast<const GuardPage*>(mapped);
  // A copy: a program that goes astray may write anywhere.
  LettingGo letting_go = page.letting_go;
  be_prompt();
  if (send(guard_to_program, &guard_is_ready, 1, MSG_NOSIGNAL) != 1) return 1;
  if (!watch(page, letting_go)) (void)let_go(letting_go);
  return 0;
}
