#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "protocol/felt_level.h"

namespace kerf::bench {

/// What of a force is fast enough to be felt as a buzz, or heard from the device: mean squares by octaves
/// from 20 Hz to 1 kHz, or half the rate, over windows of a quarter of a second under a Hann window, which
/// overlap by half (Welch; compare::band_levels()). Stretches count by their length.
class VibrationMeter {
 public:
  VibrationMeter(std::size_t axes, double rate_hz) : axes_(axes), rate_hz_(rate_hz) {}

  /// A stretch of ticks x axes [N], without a break in time. One shorter than a window tells nothing.
  void add(std::span<const double> force_n);
  /// Sets what is said of vibration; NaN where no stretch was long enough.
  void put_into(FeltLevel& level) const;

 private:
  struct Band {
    double threshold_n = 0.0;
    double square_ticks = 0.0;  ///< N² times ticks
  };
  std::size_t axes_;
  double rate_hz_;
  std::vector<Band> bands_;
  double ticks_ = 0.0;
};

}  // namespace kerf::bench
