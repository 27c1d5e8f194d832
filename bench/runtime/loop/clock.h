#pragma once

#include <cerrno>
#include <cstdint>

#include <time.h>

#include "host/realtime.h"

namespace kerf::bench {

/// The machine's monotonic clock. Sleeps until shortly before a deadline and spins the rest, because a
/// sleeper is woken late by some tens of microseconds: learn_spin_ns() says by how many on this machine.
class WallClock {
 public:
  static constexpr std::int64_t usual_spin_ns = 100'000;

  explicit WallClock(std::int64_t spin_ns = usual_spin_ns) noexcept : spin_ns_(spin_ns) {}

  [[nodiscard]] static std::int64_t now_ns() noexcept { return read(CLOCK_MONOTONIC); }

  /// Time that a processor has spent on this thread: what a computation cost, also where the thread was made
  /// to wait. A system call of some 0.2 us.
  [[nodiscard]] static std::int64_t cpu_ns() noexcept { return read(CLOCK_THREAD_CPUTIME_ID); }

  /// What the system has counted for this thread.
  [[nodiscard]] static ThreadUsage usage() noexcept { return ThreadUsage::now(); }

  void sleep_until(std::int64_t deadline_ns) const noexcept {
    if (const std::int64_t wake_ns = deadline_ns - spin_ns_; now_ns() < wake_ns) sleep_to(wake_ns);
    while (now_ns() < deadline_ns) {
    }
  }

 private:
  static void sleep_to(std::int64_t wake_ns) noexcept {
    const timespec wake{.tv_sec = wake_ns / 1'000'000'000, .tv_nsec = wake_ns % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
    }
  }

  static std::int64_t read(clockid_t clock) noexcept {
    timespec now{};
    clock_gettime(clock, &now);
    return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
  }

  std::int64_t spin_ns_;
};

/// A clock that stands still while the tick works and jumps to the next deadline: the same loop, as fast as
/// the machine can, and the same to the last bit each time.
class VirtualClock {
 public:
  [[nodiscard]] std::int64_t now_ns() const noexcept { return now_ns_; }
  [[nodiscard]] static std::int64_t cpu_ns() noexcept { return 0; }
  [[nodiscard]] ThreadUsage usage() const noexcept { return {.voluntary_switches = waits_}; }
  void sleep_until(std::int64_t deadline_ns) noexcept {
    if (deadline_ns > now_ns_) now_ns_ = deadline_ns;
  }
  /// Something made the loop wait for so long.
  void pass(std::int64_t duration_ns) noexcept {
    now_ns_ += duration_ns;
    ++waits_;
  }

 private:
  std::int64_t now_ns_ = 0;
  std::int64_t waits_ = 0;
};

}  // namespace kerf::bench
