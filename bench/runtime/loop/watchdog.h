#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

#include <kerf/drivers/device.h>

namespace kerf::bench {

/// How long a loop of so many seconds a period may be silent: 10 ms, or three periods where these are longer.
[[nodiscard]] constexpr std::int64_t watchdog_limit_ns(double period_s) noexcept {
  return std::max<std::int64_t>(10'000'000, static_cast<std::int64_t>(3e9 * period_s));
}

/// The sign of life that a loop gives once a tick, and whether the watchdog has acted since the last one.
class Heartbeat {
 public:
  /// The loop begins; loop time is 0 at `start_ns` of its clock.
  void start(std::int64_t start_ns) noexcept {
    start_ns_.store(start_ns, std::memory_order_relaxed);
    beat_ns_.store(start_ns, std::memory_order_relaxed);
    running_.store(true, std::memory_order_release);
  }
  void stop() noexcept { running_.store(false, std::memory_order_release); }

  /// Called by the loop once a tick. Returns whether it had been silent for longer than the limit, or the
  /// watchdog thought so.
  bool beat(std::int64_t now_ns, std::int64_t limit_ns) noexcept {
    const std::int64_t silent_ns = now_ns - beat_ns_.load(std::memory_order_relaxed);
    beat_ns_.store(now_ns, std::memory_order_relaxed);
    const bool acted = acted_.load(std::memory_order_acquire);
    if (acted) acted_.store(false, std::memory_order_relaxed);
    return acted || silent_ns > limit_ns;
  }

  /// When the limit will be reached if no beat comes, on the loop's clock.
  [[nodiscard]] std::int64_t due_ns(std::int64_t limit_ns) const noexcept {
    return beat_ns_.load(std::memory_order_relaxed) + limit_ns;
  }
  /// Releases the device of a loop that is silent at `now_ns`, once; returns whether it did.
  bool release_if_silent(drivers::Device& device, std::int64_t now_ns, std::int64_t limit_ns) noexcept {
    if (!running_.load(std::memory_order_acquire) || acted_.load(std::memory_order_relaxed)) return false;
    const std::int64_t due = due_ns(limit_ns);
    if (now_ns <= due) return false;
    acted_.store(true, std::memory_order_release);
    device.release(1e-9 * static_cast<double>(due - start_ns_.load(std::memory_order_relaxed)));
    return true;
  }

 private:
  std::atomic<std::int64_t> start_ns_{0};
  std::atomic<std::int64_t> beat_ns_{0};
  std::atomic<bool> running_{false};
  std::atomic<bool> acted_{false};
};

/// Releases a device whose loop has been silent for too long, from a thread of its own that is more urgent
/// than the loop (where permitted) and off its processor. By the wall clock only.
class Watchdog {
 public:
  Watchdog(drivers::Device& device, Heartbeat& heartbeat, double period_s);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  ~Watchdog() = default;

 private:
  std::jthread thread_;
};

}  // namespace kerf::bench
