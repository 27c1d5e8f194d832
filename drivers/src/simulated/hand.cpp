#include "kerf/drivers/hand.h"

#include <algorithm>

#include "kerf/drivers/gaussian.h"

namespace kerf::drivers {
namespace {

constexpr std::size_t strokes_drawn = 4096;  ///< over an hour of cutting; then the last one holds

}  // namespace

MinimumJerk MinimumJerk::at(double s) noexcept {
  s = std::clamp(s, 0.0, 1.0);
  return {.position = s * s * s * (10.0 + s * (-15.0 + 6.0 * s)),
          .speed = 30.0 * s * s * (1.0 - s) * (1.0 - s)};
}

Strokes::Strokes(const HandOptions& options) {
  Gaussian random(options.seed);
  const auto varied = [&](double value) {
    return value * (1.0 + options.variation * std::clamp(random(), -2.0, 2.0));
  };
  double time_s = options.pause_s;
  double angle_rad = options.open_rad;
  for (std::size_t i = 0; i < strokes_drawn; ++i) {
    const bool closing = i % 2 == 0;
    // The travel varies, not the angle itself, so that a hand that closes to zero varies too.
    const double travel =
        varied(options.open_rad - options.close_rad) - (options.open_rad - options.close_rad);
    const double target_rad = closing ? options.close_rad + 0.5 * travel : options.open_rad + 0.5 * travel;
    const double duration_s = varied(options.stroke_s);
    strokes_.push_back(
        {.begin_s = time_s, .duration_s = duration_s, .from_rad = angle_rad, .to_rad = target_rad});
    angle_rad = target_rad;
    time_s += duration_s + varied(options.pause_s);
  }
}

Strokes::Equilibrium Strokes::at(double time_s) noexcept {
  while (current_ + 1 < strokes_.size() && time_s >= strokes_[current_ + 1].begin_s) ++current_;
  const Stroke& stroke = strokes_[current_];
  const MinimumJerk motion = MinimumJerk::at((time_s - stroke.begin_s) / stroke.duration_s);
  const double travel = stroke.to_rad - stroke.from_rad;
  return {.angle_rad = stroke.from_rad + travel * motion.position,
          .speed_rad_s = travel * motion.speed / stroke.duration_s};
}

}  // namespace kerf::drivers
