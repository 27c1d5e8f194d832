#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include <kerf/drivers/device.h>

namespace kerf::drivers {

/// Velocity from positions as a driver gives it: their difference over the time between two readings,
/// low-passed at first order with a corner, of 20 Hz unless another one is given, so that it lags by some 8
/// ms. Zero at the first reading.
class VelocityFilter {
 public:
  static constexpr double corner_rad_s = 2.0 * std::numbers::pi * 20.0;

  /// The velocity of an axis that stands at `position` at `now_s`; each axis once a reading, then advance().
  /// A corner of 0: the plain difference.
  double update(std::size_t axis, double position, double now_s, double corner = corner_rad_s) noexcept {
    const double elapsed_s = now_s - last_s_;
    if (started_ && elapsed_s > 0.0) {
      const double difference = (position - last_position_[axis]) / elapsed_s;
      const double gain = corner > 0.0 ? -std::expm1(-corner * elapsed_s) : 1.0;
      velocity_[axis] += gain * (difference - velocity_[axis]);
    }
    last_position_[axis] = position;
    return velocity_[axis];
  }
  void advance(double now_s) noexcept {
    last_s_ = now_s;
    started_ = true;
  }
  /// What it gave last.
  [[nodiscard]] double velocity(std::size_t axis) const noexcept { return velocity_[axis]; }
  /// A position from which the next difference is taken, without one to it.
  void restart(std::size_t axis, double position) noexcept { last_position_[axis] = position; }

 private:
  Axes last_position_{};
  Axes velocity_{};
  double last_s_ = 0.0;
  bool started_ = false;
};

}  // namespace kerf::drivers
