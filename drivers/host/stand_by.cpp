#include "stand_by.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "kerf/drivers/urgent_thread.h"
#include "plugin.h"

namespace kerf::host {
namespace {

using drivers::hosted::Page;

constexpr std::int64_t watch_ns = 10'000'000;
constexpr std::int64_t patience_ns = 1'000'000'000;  // with a host whose program is gone
constexpr unsigned longest_release_s = 2;

void let_go(const Opened& opened, Page& page) noexcept {
  if (opened.description.release == nullptr) return;
  alarm(longest_release_s);  // SIGALRM ends this process: what hangs here hangs for ever
  opened.description.release(opened.device);
  alarm(0);
  page.let_go_instead.fetch_add(1);
}

[[noreturn]] void watch(const Opened& opened, Page& page, int life, pid_t host) noexcept {
  std::int64_t done_for_ns = 0;  // once for each time that ran out: the host may come back
  std::int64_t gone_since_ns = 0;
  for (;;) {
    const std::int64_t until_ns = page.until_ns.load(std::memory_order_acquire);
    const bool held = until_ns != 0 && until_ns != done_for_ns;
    const std::int64_t wait_ns = held ? std::clamp<std::int64_t>(until_ns - now_ns(), 0, watch_ns) : watch_ns;
    const timespec wait{.tv_sec = 0, .tv_nsec = wait_ns};
    pollfd end{.fd = life, .events = 0, .revents = 0};
    if (ppoll(&end, 1, &wait, nullptr) > 0) break;  // the host has ended
    if (held && page.until_ns.load(std::memory_order_acquire) == until_ns && now_ns() >= until_ns) {
      let_go(opened, page);
      done_for_ns = until_ns;
    }
    if (!program_is_gone()) {
      gone_since_ns = 0;
    } else if (gone_since_ns == 0) {
      gone_since_ns = now_ns();
    } else if (now_ns() - gone_since_ns > patience_ns) {
      (void)kill(host, SIGKILL);
    }
  }
  if (page.standby_may_go.load(std::memory_order_acquire) == 0) {
    let_go(opened, page);
    page.host_ended.store(1, std::memory_order_release);
  }
  _exit(0);
}

}  // namespace

pid_t stand_by(const Opened& opened, Page& page) {
  std::array<int, 2> life{};  // its end is the host's
  if (pipe2(life.data(), O_CLOEXEC) != 0) throw Refusal(std::string("a pipe: ") + std::strerror(errno));
  const pid_t host = getpid();
  const pid_t copy = fork();
  if (copy < 0) {
    throw Refusal(std::string("nobody can stand by to let the device go: ") + std::strerror(errno));
  }
  if (copy > 0) {
    close(life[0]);
    return copy;  // life[1] stays open as long as this process lives
  }
  close(life[1]);
  sigset_t alarms;
  sigemptyset(&alarms);
  sigaddset(&alarms, SIGALRM);
  (void)signal(SIGALRM, SIG_DFL);
  sigprocmask(SIG_UNBLOCK, &alarms, nullptr);
  drivers::become_urgent("kerf-let-go");
  (void)mlockall(MCL_CURRENT | MCL_FUTURE);
  const int spared = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (spared >= 0) {
    [[maybe_unused]] const auto written = write(spared, "-1000", 5);
    close(spared);
  }
  watch(opened, page, life[0], host);
}

}  // namespace kerf::host
