#pragma once

#include <atomic>
#include <limits>

#include "protocol/guide/guided_motion.h"

namespace kerf::bench {

/// Where guide and tool are, from the tick to whoever shows them: two numbers that are stored and read alone,
/// so that neither waits for the other.
class LiveGuide {
 public:
  static_assert(std::atomic<double>::is_always_lock_free);
  /// The tick's.
  void store(double time_s, double position) noexcept {
    position_.store(position, std::memory_order_relaxed);
    time_s_.store(time_s, std::memory_order_relaxed);
  }
  [[nodiscard]] GuideLook look() const noexcept {
    return {.time_s = time_s_.load(std::memory_order_relaxed),
            .position = position_.load(std::memory_order_relaxed)};
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::atomic<double> time_s_{unknown};
  std::atomic<double> position_{unknown};
};

}  // namespace kerf::bench
