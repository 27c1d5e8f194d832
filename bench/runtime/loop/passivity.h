#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <kerf/drivers/device.h>

namespace kerf::bench {

/// Energy that the rendering has taken out of the hand, by the force held over each tick and the travel in it
/// [HannafordRyu2002]. A rendering is passive while it never has given more than it took.
class PassivityObserver {
 public:
  explicit PassivityObserver(const std::vector<drivers::AxisInfo>& axes) noexcept : count_(axes.size()) {
    for (std::size_t axis = 0; axis < count_; ++axis) lever_[axis] = axes[axis].lever;
  }

  /// The force held since the last tick, and where it has brought the device.
  void observe(const drivers::Axes& held_force, const drivers::Axes& position) noexcept {
    for (std::size_t axis = 0; started_ && axis < count_; ++axis) {
      energy_j_ -= held_force[axis] * lever_[axis] * (position[axis] - last_[axis]);
    }
    restart(position);
    least_j_ = std::min(least_j_, energy_j_);
  }

  /// The device was not moved here by a force: an encoder slipped, or readings were missing.
  void restart(const drivers::Axes& position) noexcept {
    last_ = position;
    started_ = true;
  }

  /// The passivity controller: a damping force for the period ahead that takes back the energy that was
  /// given,
  ///
  ///     F = -alpha v,   alpha = -E / (T |v|^2)   while E < 0
  ///
  /// over the speeds v of all axes in the period behind, their travel over its length: the velocity of a
  /// driver lags by its filter, and braking on it may push (docs/where-methods-fail.md). At less than 0.1
  /// mm/s the quotient means nothing and there is none. Returns whether it acted. Source: [HannafordRyu2002],
  /// eq. 6 to 9.
  bool control(const drivers::Axes& velocity, double period_s, drivers::Axes& force) const noexcept {
    constexpr double least_speed_m_s = 1e-4;
    if (energy_j_ >= 0.0) return false;
    double speed_squared = 0.0;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      speed_squared += std::pow(lever_[axis] * velocity[axis], 2);
    }
    if (speed_squared < least_speed_m_s * least_speed_m_s) return false;
    const double alpha = -energy_j_ / (period_s * speed_squared);
    for (std::size_t axis = 0; axis < count_; ++axis) force[axis] -= alpha * lever_[axis] * velocity[axis];
    return true;
  }

  [[nodiscard]] double energy_j() const noexcept { return energy_j_; }
  [[nodiscard]] double least_j() const noexcept { return least_j_; }

 private:
  std::size_t count_;
  drivers::Axes lever_{};
  drivers::Axes last_{};
  double energy_j_ = 0.0;
  double least_j_ = 0.0;
  bool started_ = false;
};

}  // namespace kerf::bench
