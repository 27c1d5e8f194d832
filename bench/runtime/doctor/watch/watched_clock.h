#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include "doctor/watch/late_wakes.h"
#include "host/histogram.h"
#include "loop/clock.h"

namespace kerf::bench::doctor {

/// How long the calling thread could have run and waited for a processor: the second number of
/// /proc/thread-self/schedstat, which the kernel tells with CONFIG_SCHED_INFO.
class OwnRunDelay {
 public:
  OwnRunDelay() noexcept : descriptor_(open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {}
  OwnRunDelay(const OwnRunDelay&) = delete;
  OwnRunDelay& operator=(const OwnRunDelay&) = delete;
  ~OwnRunDelay() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  /// Since the thread began [ns]; -1: it is not told. A read of some 1 us.
  [[nodiscard]] std::int64_t now_ns() const noexcept {
    std::array<char, 96> text{};
    const ssize_t count = descriptor_ < 0 ? -1 : pread(descriptor_, text.data(), text.size(), 0);
    if (count <= 0) return -1;
    const std::string_view words(text.data(), static_cast<std::size_t>(count));
    const auto blank = words.find(' ');
    if (blank == std::string_view::npos) return -1;
    std::int64_t delay_ns = -1;
    std::from_chars(words.data() + blank + 1, words.data() + words.size(), delay_ns);
    return delay_ns;
  }

 private:
  int descriptor_;
};

/// The clock on the wall that keeps the evidence of every late wake-up of the thread that it is made on.
///
/// It asks the kernel before it goes to sleep, when there is time, and again only once it is late: what a
/// tick itself may not do (open and read files) happens between ticks, or in one that has failed already.
class WatchedClock {
 public:
  /// `late_ns`: later than that is late. `spin_ns`: as of WallClock.
  WatchedClock(LateWakes& late, std::int64_t late_ns, std::int64_t spin_ns, bool is_loop) noexcept
      : late_(late),
        wall_(spin_ns),
        late_ns_(late_ns),
        spin_ns_(spin_ns),
        is_loop_(is_loop),
        priority_(own_priority()) {}

  [[nodiscard]] static std::int64_t now_ns() noexcept { return WallClock::now_ns(); }
  [[nodiscard]] static std::int64_t cpu_ns() noexcept { return WallClock::cpu_ns(); }
  [[nodiscard]] static ThreadUsage usage() noexcept { return WallClock::usage(); }

  void sleep_until(std::int64_t deadline_ns) noexcept {
    const std::int64_t begin_ns = now_ns();
    const bool sleeps = begin_ns < deadline_ns - spin_ns_;
    if (sleeps) {
      run_delay_ns_ = run_delay_.now_ns();
      usage_ = usage();
      told_ = false;
    }
    wall_.sleep_until(deadline_ns);
    const std::int64_t woken_ns = now_ns();
    if (begin_ns > deadline_ns || told_ || woken_ns - deadline_ns <= late_ns_) return;
    told_ = true;  // the loop asks twice for one tick, and is late once
    const std::int64_t delay_ns = run_delay_.now_ns();
    late_.push({.due_ns = deadline_ns,
                .woken_ns = woken_ns,
                .run_delay_ns = delay_ns < 0 || run_delay_ns_ < 0 ? -1 : delay_ns - run_delay_ns_,
                .usage = usage().since(usage_),
                .priority = priority_,
                .is_loop = is_loop_});
  }

 private:
  static int own_priority() noexcept {
    sched_param parameters{};
    return sched_getparam(0, &parameters) == 0 ? parameters.sched_priority : 0;
  }

  LateWakes& late_;
  OwnRunDelay run_delay_;
  WallClock wall_;
  std::int64_t late_ns_;
  std::int64_t spin_ns_;
  bool is_loop_;
  int priority_;
  std::int64_t run_delay_ns_ = -1;
  ThreadUsage usage_;
  bool told_ = false;
};

}  // namespace kerf::bench::doctor
