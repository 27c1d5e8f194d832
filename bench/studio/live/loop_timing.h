#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <kerf/schema/recording.h>

#include "host/histogram.h"

namespace kerf::bench {

/// Wake latency and cycle (reading, computing and writing) of a running loop, by its rows: over all of them,
/// and over the last 9 to 10 s.
class LoopTiming {
 public:
  struct Timing {
    Histogram wake;
    Histogram cycle;

    void add(const Timing& other) noexcept {
      wake.add(other.wake);
      cycle.add(other.cycle);
    }
  };

  /// Rows in the order of their times.
  void add(const schema::Row& row) noexcept {
    const auto second = static_cast<std::uint64_t>(row.time_s);
    // At most one round: what lies between was silence.
    for (std::size_t passed = 0; second_ < second && passed < seconds_.size(); ++passed, ++second_) {
      seconds_[(second_ + 1) % seconds_.size()] = {};
    }
    second_ = second;
    count(row, seconds_[second % seconds_.size()]);
    count(row, whole_);
  }

  [[nodiscard]] Timing recent() const noexcept {
    Timing sum;
    for (const Timing& second : seconds_) sum.add(second);
    return sum;
  }
  [[nodiscard]] const Timing& whole() const noexcept { return whole_; }

 private:
  static void count(const schema::Row& row, Timing& timing) noexcept {
    timing.wake.add(std::llround(1e9 * static_cast<double>(row.wake_latency_s)));
    timing.cycle.add(
        std::llround(1e9 * static_cast<double>(row.read_time_s + row.compute_time_s + row.write_time_s)));
  }

  std::array<Timing, 10> seconds_;  ///< by the second of loop time, modulo their number
  std::uint64_t second_ = 0;        ///< of the last row
  Timing whole_;
};

}  // namespace kerf::bench
