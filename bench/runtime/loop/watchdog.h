#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <latch>
#include <span>
#include <thread>
#include <utility>

#include <kerf/drivers/device.h>

namespace kerf::bench {

/// How long a loop of so many seconds a period may be silent: 10 ms, or three periods where these are longer.
[[nodiscard]] constexpr std::int64_t watchdog_limit_ns(double period_s) noexcept {
  return std::max<std::int64_t>(10'000'000, static_cast<std::int64_t>(3e9 * period_s));
}

/// A loop that was silent for longer than it may be.
struct Stall {
  std::int64_t from_ns = 0;            ///< its last sign of life, on its clock
  std::int64_t silent_ns = 0;          ///< up to the next one
  std::int64_t released_after_ns = 0;  ///< when the watchdog let go of the device; 0: it did not
  bool suspended = false;              ///< somebody stopped the process (Ctrl-Z), after zero force
};

/// The sign of life that a loop gives once a tick, and whether the watchdog has acted since the last one.
class Heartbeat {
 public:
  static constexpr std::size_t max_stalls = 64;

  /// The loop begins; loop time is 0 at `start_ns` of its clock.
  void start(std::int64_t start_ns) noexcept {
    start_ns_.store(start_ns, std::memory_order_relaxed);
    beat_ns_.store(start_ns, std::memory_order_relaxed);
    stalls_ = 0;
    running_.store(true, std::memory_order_release);
  }
  void stop() noexcept { running_.store(false, std::memory_order_release); }

  /// Called by the loop once a tick. Returns whether it had been silent for longer than the limit, or the
  /// watchdog thought so.
  bool beat(std::int64_t now_ns, std::int64_t limit_ns) noexcept {
    const std::int64_t before_ns = beat_ns_.load(std::memory_order_relaxed);
    beat_ns_.store(now_ns, std::memory_order_relaxed);
    const std::int64_t released_ns = released_ns_.load(std::memory_order_acquire);
    if (released_ns != 0) released_ns_.store(0, std::memory_order_relaxed);
    const bool suspended = suspended_.load(std::memory_order_acquire);
    const bool was_suspended = std::exchange(was_suspended_, suspended);
    const bool silent = now_ns - before_ns > limit_ns;
    if (released_ns == 0 && !silent && !suspended) return false;
    if ((suspended || was_suspended) && !silent) return true;
    if (stalls_ < max_stalls) {
      stall_[stalls_] = {.from_ns = before_ns - start_ns_.load(std::memory_order_relaxed),
                         .silent_ns = now_ns - before_ns,
                         .released_after_ns = released_ns != 0 ? released_ns - before_ns : 0,
                         .suspended = suspended || was_suspended};
    }
    ++stalls_;
    return true;
  }

  /// From now on every beat asks for zero force, until resume(): the process is about to be stopped.
  void suspend() noexcept { suspended_.store(true, std::memory_order_release); }
  void resume() noexcept { suspended_.store(false, std::memory_order_release); }

  /// Whether a loop that has been silent for longer than the limit was so together with the watchdog, which
  /// has not released the device, or much too late: the whole process stood still.
  [[nodiscard]] bool stands_still(std::int64_t now_ns, std::int64_t limit_ns) const noexcept {
    const std::int64_t beat_ns = beat_ns_.load(std::memory_order_relaxed);
    const std::int64_t silent_ns = now_ns - beat_ns;
    if (silent_ns <= limit_ns) return false;
    const std::int64_t released_ns = released_ns_.load(std::memory_order_acquire);
    return released_ns == 0 || released_ns - beat_ns > (limit_ns + silent_ns) / 2;
  }

  /// Time since the loop began.
  [[nodiscard]] std::int64_t loop_ns(std::int64_t now_ns) const noexcept {
    return now_ns - start_ns_.load(std::memory_order_relaxed);
  }

  /// When the limit will be reached if no beat comes, on the loop's clock.
  [[nodiscard]] std::int64_t due_ns(std::int64_t limit_ns) const noexcept {
    return beat_ns_.load(std::memory_order_relaxed) + limit_ns;
  }
  /// Releases the device of a loop that is silent at `now_ns`, once; returns whether it did.
  bool release_if_silent(drivers::Device& device, std::int64_t now_ns, std::int64_t limit_ns) noexcept {
    if (!running_.load(std::memory_order_acquire) || released_ns_.load(std::memory_order_relaxed) != 0) {
      return false;
    }
    if (now_ns <= due_ns(limit_ns)) return false;
    released_ns_.store(now_ns, std::memory_order_release);
    device.release(1e-9 * static_cast<double>(loop_ns(now_ns)));
    return true;
  }

  /// The first max_stalls of them, times since the loop began. Once the loop has ended.
  [[nodiscard]] std::span<const Stall> stalls() const noexcept {
    return std::span(stall_).first(std::min(stalls_, max_stalls));
  }

 private:
  std::atomic<std::int64_t> start_ns_{0};
  std::atomic<std::int64_t> beat_ns_{0};
  std::atomic<bool> running_{false};
  std::atomic<std::int64_t> released_ns_{0};  ///< 0: not since the last beat
  std::atomic<bool> suspended_{false};
  // The loop's.
  bool was_suspended_ = false;
  std::array<Stall, max_stalls> stall_{};
  std::size_t stalls_ = 0;
};

/// Releases a device whose loop has been silent for too long, from a thread of its own that is more urgent
/// than the loop (where permitted) and off its processor. By the wall clock only.
///
/// Where `stop_process` is set (by the handler of Ctrl-Z) it first lets the loop give zero force, and then
/// stops the process; once that goes on the force comes back along the ramp.
class Watchdog {
 public:
  Watchdog(drivers::Device& device, Heartbeat& heartbeat, double period_s,
           std::atomic<bool>* stop_process = nullptr);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  ~Watchdog() = default;

 private:
  std::latch started_{1};  ///< what it obtained is known once it stands
  std::jthread thread_;
};

}  // namespace kerf::bench
