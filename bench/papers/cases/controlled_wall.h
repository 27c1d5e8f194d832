#pragma once

#include <algorithm>

#include "cases/devices.h"
#include "cases/trace.h"
#include "stability/device/passivity_controlled.h"
#include "stability/wall/wall_force.h"

namespace kerf::bench {

/// Energy in the spring of a one-sided wall.
struct WallEnergy {
  double stiffness_n_per_m = 0.0;
  double operator()(const WallForce&, const AxisReading& at) const noexcept {
    const double inside_m = std::max(at.position_m, 0.0);
    return 0.5 * stiffness_n_per_m * inside_m * inside_m;
  }
};
using ControlledWall = PassivityControlled<WallForce, WallEnergy>;

/// The handle under a weight: nothing but its own friction brakes it.
inline SampledDevice weighted_scissors() {
  SampledDevice device = scissors_handle();
  device.hand.mass_kg = 0.1;
  return device;
}

inline constexpr double leaning_n = 4.0;
inline constexpr double above_wall_m = 5e-3;

/// A weight of 4 N that falls on a wall from 5 mm above it.
template <typename Force>
[[nodiscard]] CaseTrace lean_on(const SampledDevice& device, Force wall, double seconds = 3.0) {
  return run_loop(device, std::move(wall), {.position_m = -above_wall_m}, seconds,
                  [](double) { return HandPush{.force_n = leaning_n}; });
}

}  // namespace kerf::bench
