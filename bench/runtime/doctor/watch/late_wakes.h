#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/realtime.h"

namespace kerf::bench::doctor {

/// A thread was woken later than it had asked for.
struct LateWake {
  std::int64_t due_ns = 0;         ///< when it wanted to run, by the monotonic clock
  std::int64_t woken_ns = 0;       ///< when it ran
  std::int64_t run_delay_ns = -1;  ///< so long it could have run and waited for the processor; -1: not told
  ThreadUsage usage;               ///< what was counted for it since it went to sleep
  int priority = 0;                ///< of SCHED_FIFO; 0: it was scheduled as any other
  bool is_loop = false;            ///< of the loop, not of the sleeper

  [[nodiscard]] std::int64_t late_ns() const noexcept { return woken_ns - due_ns; }
};

/// The late wake-ups of one thread. It takes its memory when it is made; who watches reads how many there
/// are.
class LateWakes {
 public:
  static constexpr std::size_t most = 4096;
  LateWakes() : kept_(most) {}
  LateWakes(const LateWakes&) = delete;
  LateWakes& operator=(const LateWakes&) = delete;

  /// By the one thread that is late.
  void push(const LateWake& wake) noexcept {
    const std::size_t at = count_.load(std::memory_order_relaxed);
    if (at < most) kept_[at] = wake;
    count_.store(at + 1, std::memory_order_release);
  }
  /// All of them, those that were not kept included.
  [[nodiscard]] std::size_t count() const noexcept { return count_.load(std::memory_order_acquire); }
  /// The first ones. Once the thread has ended.
  [[nodiscard]] std::span<const LateWake> kept() const noexcept {
    return std::span(kept_).first(std::min(count(), most));
  }

 private:
  std::vector<LateWake> kept_;
  std::atomic<std::size_t> count_{0};
};

}  // namespace kerf::bench::doctor
