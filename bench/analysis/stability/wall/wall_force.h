#pragma once

#include <algorithm>

#include "stability/device/sampled_loop.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench {

/// A virtual wall that begins at 0 as the Force of a SampledLoop: one-sided it never pulls, otherwise it
/// pulls as it pushes, also in front of the wall.
struct WallForce {
  Wall wall;
  bool one_sided = true;
  double operator()(const AxisReading& reading) const noexcept {
    if (one_sided && reading.position_m <= 0.0) return 0.0;
    const double force =
        -wall.stiffness_n_per_m * reading.position_m - wall.damping_n_s_per_m * reading.speed_m_s;
    return one_sided ? std::min(force, 0.0) : force;
  }
};

}  // namespace kerf::bench
