#include "devices/held_tip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <kerf/drivers/simulated_mechanism.h>

namespace kerf::emulators {
namespace {

constexpr double step_s = drivers::SimulatedMechanism::sub_step_s;
constexpr std::array sway_hz{0.31, 0.43, 0.59};

}  // namespace

HeldTip::HeldTip(const Options& options)
    : options_(options),
      axis_{.mass_kg = options.mass_kg,
            .hand_stiffness_n_per_m = options.hand_stiffness_n_per_m,
            .hand_damping_n_s_per_m = options.hand_damping_n_s_per_m,
            .lower_m = -options.max_travel_m,
            .upper_m = options.max_travel_m} {
  if (options.free) free_.emplace(*options.free);
}

void HeldTip::push(const Eigen::Vector3d& force_n) {
  force_n_ = force_n;
  if (free_) free_->push(force_n);
}

void HeldTip::run_until(double time_s) {
  if (free_) {
    free_->run_until(time_s);
    return;
  }
  const auto target = static_cast<std::uint64_t>(std::llround(std::max(0.0, time_s) / step_s));
  while (steps_ < target) {
    const double now_s = static_cast<double>(++steps_) * step_s;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double rate = 2.0 * std::numbers::pi * sway_hz[axis];
      const auto at = static_cast<Eigen::Index>(axis);
      axis_.step(states_[axis],
                 {.equilibrium_m = lead_m_[at] + options_.sway_m * std::sin(rate * now_s),
                  .equilibrium_speed_m_s = options_.sway_m * rate * std::cos(rate * now_s),
                  .force_n = force_n_[at]},
                 step_s);
    }
  }
}

Eigen::Vector3d HeldTip::position() const noexcept {
  if (free_) return options_.centre_m + free_->travel();
  return options_.centre_m + Eigen::Vector3d(states_[0].travel_m, states_[1].travel_m, states_[2].travel_m);
}

}  // namespace kerf::emulators
