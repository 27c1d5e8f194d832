#pragma once

#include <cerrno>
#include <cstdint>

#include <time.h>

namespace kerf::bench {

/// The machine's monotonic clock. Sleeps until shortly before a deadline and spins the rest, because a
/// sleeper is woken late by some tens of microseconds.
class WallClock {
 public:
  explicit WallClock(std::int64_t spin_ns = 100'000) noexcept : spin_ns_(spin_ns) {}

  [[nodiscard]] static std::int64_t now_ns() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
  }

  void sleep_until(std::int64_t deadline_ns) const noexcept {
    const std::int64_t wake_ns = deadline_ns - spin_ns_;
    const timespec wake{.tv_sec = wake_ns / 1'000'000'000, .tv_nsec = wake_ns % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
    }
    while (now_ns() < deadline_ns) {
    }
  }

 private:
  std::int64_t spin_ns_;
};

/// A clock that stands still while the tick works and jumps to the next deadline: the same loop, as fast as
/// the machine can, and the same to the last bit each time.
class VirtualClock {
 public:
  [[nodiscard]] std::int64_t now_ns() const noexcept { return now_ns_; }
  void sleep_until(std::int64_t deadline_ns) noexcept {
    if (deadline_ns > now_ns_) now_ns_ = deadline_ns;
  }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace kerf::bench
