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
    last_ = position;
    started_ = true;
    least_j_ = std::min(least_j_, energy_j_);
  }

  /// What comes until the next reading was no work of a force: an encoder slipped, readings were missing, or
  /// the force was let go.
  void restart() noexcept { started_ = false; }

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

/// Adds damping where the rendering has given energy that it neither stored nor took.
///
/// What a tick leaves, with the force F that was held over the travel dx, the energy U that the rendering
/// means to store, the share s of the rendering's force that the hand got, and the viscous friction b of the
/// device over the tick's length t:
///
///     E += -F dx - s dU + b dx^2 / t,   summed over the axes
///
/// Without U all that is pressed into a wall would be a reserve that a limit cycle may use up; without b
/// walls would be braked that the device keeps passive by itself. Coulomb friction is left out of the
/// account. A surplus is forgotten in the tick in which it comes about (E <= 0): neither a cut nor the way
/// through free air pays for a limit cycle. Of a rendering that does not say what it stores (NaN) the surplus
/// is forgotten when its force has come to zero. A debt is taken back by a damping force for the period T
/// ahead,
///
///     F = -a v,   a = min(-E / (T |v|^2), m / T)
///
/// on the travel of the tick behind over its length: the velocity of a driver lags by its filter. More than m
/// / T would turn the motion round within a period; m is the effective mass of the axis, and where that is
/// not known 10 g, or 1e-5 kg·m^2 of an axis in N·m: less than any device of the field has. Below 0.1 mm/s
/// the quotient means nothing and there is no damping. A debt that is left 10 ms after the rendering let go
/// is forgotten, so that nothing drags in free air.
///
/// Of a spring K each tick leaves (b - K T / 2) v^2 T: the controller never acts up to K = 2 b / T, and
/// beyond adds the damping that is missing, K T / 2 - b. Source: [HannafordRyu2002], eq. 6 to 9; account of
/// the stored energy and bound of the damping: ours.
class PassivityController {
 public:
  PassivityController(const std::vector<drivers::AxisInfo>& axes, double period_s) noexcept
      : count_(axes.size()), period_s_(period_s) {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      constexpr double least_mass_kg = 0.01;
      constexpr double least_inertia_kg_m2 = 1e-5;
      const bool turns = axes[axis].force_unit == "N·m";
      const auto known = axes[axis].mechanics.value_or(
          drivers::Mechanics{.mass_kg = turns ? least_inertia_kg_m2 : least_mass_kg});
      lever_[axis] = axes[axis].lever;
      viscous_[axis] = known.viscous_n_s_per_m;
      most_damping_[axis] = known.mass_kg / period_s;
    }
  }

  /// What was measured of an axis takes the place of what the driver knows.
  void know(std::size_t axis, const drivers::Mechanics& measured) noexcept {
    viscous_[axis] = measured.viscous_n_s_per_m;
    most_damping_[axis] = measured.mass_kg / period_s_;
  }

  /// Forgets everything. What comes until the next reading is no work of a force.
  void restart() noexcept {
    energy_j_ = 0.0;
    started_ = false;
  }

  /// A reading `elapsed_s` after the one before, in which the rendering's store grew by `stored_change_j`.
  void observe(const drivers::Axes& position, double elapsed_s, double stored_change_j) noexcept {
    const bool knows_store = std::isfinite(stored_change_j);
    double left_j = 0.0;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      const double travel = started_ ? lever_[axis] * (position[axis] - last_[axis]) : 0.0;
      speed_[axis] = travel / elapsed_s;
      left_j += (viscous_[axis] * speed_[axis] - held_[axis]) * travel;
    }
    if (started_ && knows_store) left_j -= share_ * stored_change_j;
    energy_j_ += left_j;
    free_s_ = is_free_ ? free_s_ + elapsed_s : 0.0;
    constexpr double debt_lasts_s = 0.01;
    if (knows_store || is_free_) energy_j_ = std::min(energy_j_, 0.0);
    if (free_s_ > debt_lasts_s) energy_j_ = 0.0;
    last_ = position;
    started_ = true;
  }

  /// Adds the damping of the period ahead. Returns whether there is any.
  bool brake(drivers::Axes& force) const noexcept {
    constexpr double least_speed_m_s = 1e-4;
    if (energy_j_ >= 0.0) return false;
    double speed_squared = 0.0;
    for (std::size_t axis = 0; axis < count_; ++axis) speed_squared += speed_[axis] * speed_[axis];
    if (speed_squared < least_speed_m_s * least_speed_m_s) return false;
    const double wanted = -energy_j_ / (period_s_ * speed_squared);
    for (std::size_t axis = 0; axis < count_; ++axis) {
      force[axis] -= std::min(wanted, most_damping_[axis]) * speed_[axis];
    }
    return true;
  }

  /// What the hand gets from now on, and what the rendering had asked for.
  void hold(const drivers::Axes& rendered, const drivers::Axes& undamped,
            const drivers::Axes& held) noexcept {
    double asked = 0.0;
    double given = 0.0;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      asked += rendered[axis] * rendered[axis];
      given += rendered[axis] * undamped[axis];
    }
    is_free_ = asked == 0.0;
    share_ = is_free_ ? 1.0 : std::clamp(given / asked, 0.0, 1.0);
    held_ = held;
  }

  [[nodiscard]] double energy_j() const noexcept { return energy_j_; }

 private:
  std::size_t count_;
  double period_s_;
  drivers::Axes lever_{};
  drivers::Axes viscous_{};
  drivers::Axes most_damping_{};
  drivers::Axes last_{};
  drivers::Axes held_{};
  drivers::Axes speed_{};  ///< of the axes' levers in the tick behind [m/s]
  double energy_j_ = 0.0;
  double share_ = 1.0;
  double free_s_ = 0.0;
  bool is_free_ = true;
  bool started_ = false;
};

}  // namespace kerf::bench
