#include "felt/vibration.h"

#include <algorithm>
#include <cmath>

#include <kerf/compare/vibration.h>

namespace kerf::bench {
namespace {

constexpr double highest_hz = 1000.0;  ///< above it a hand feels next to nothing

}  // namespace

void VibrationMeter::add(std::span<const double> force_n) {
  const std::size_t ticks = force_n.size() / axes_;
  std::vector<double> one(ticks);
  bool is_long_enough = false;
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    for (std::size_t tick = 0; tick < ticks; ++tick) one[tick] = force_n[tick * axes_ + axis];
    const std::vector<compare::BandLevel> levels = compare::band_levels(one, rate_hz_, "N");
    for (std::size_t i = 0; i < levels.size() && levels[i].from_hz < highest_hz; ++i) {
      if (i == bands_.size()) bands_.push_back({.threshold_n = levels[i].threshold});
      bands_[i].square_ticks += levels[i].rms * levels[i].rms * static_cast<double>(ticks);
      is_long_enough = true;
    }
  }
  if (is_long_enough) ticks_ += static_cast<double>(ticks);
}

void VibrationMeter::put_into(FeltLevel& level) const {
  if (ticks_ == 0.0) return;
  double square = 0.0;
  level.vibration_thresholds = 0.0;
  for (const Band& band : bands_) {
    square += band.square_ticks / ticks_;
    level.vibration_thresholds =
        std::max(level.vibration_thresholds, std::sqrt(band.square_ticks / ticks_) / band.threshold_n);
  }
  level.vibration_n = std::sqrt(square);
}

}  // namespace kerf::bench
