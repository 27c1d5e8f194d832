#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include <kerf/models/motion.h>

namespace kerf::test {

/// Where a tool wanders: between two corners, from a place outside the tissue and back to it.
struct WanderRange {
  models::AxisValues outside;
  models::AxisValues corner;
  models::AxisValues other;
};

/// A smooth closed path in that range: sines with random phases on every axis, faded in and out so that it
/// begins and ends outside and at rest.
class Wander {
 public:
  static constexpr double duration_s = 2.0;

  Wander(const WanderRange& range, unsigned seed) : range_(range) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (auto& axis : phase_) {
      for (double& phase : axis) phase = 2.0 * std::numbers::pi * uniform(random);
    }
  }
  [[nodiscard]] models::SpatialMotion at(double time_s) const {
    constexpr double h = 1e-6;
    models::SpatialMotion motion{.position = place(time_s), .velocity = {}};
    const models::AxisValues ahead = place(time_s + h);
    const models::AxisValues behind = place(time_s - h);
    for (std::size_t axis = 0; axis < models::max_law_axes; ++axis) {
      motion.velocity[axis] = (ahead[axis] - behind[axis]) / (2.0 * h);
    }
    return motion;
  }

 private:
  [[nodiscard]] models::AxisValues place(double t) const {
    const double fade = std::clamp(5.0 * std::min(t, duration_s - t), 0.0, 1.0);
    const double share = fade * fade * (3.0 - 2.0 * fade);
    models::AxisValues at{};
    for (std::size_t axis = 0; axis < models::max_law_axes; ++axis) {
      double wave = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        wave += std::sin(2.0 * std::numbers::pi * static_cast<double>(k + 1) * t + phase_[axis][k]) / 6.0;
      }
      const double to = range_.corner[axis] + (0.5 + wave) * (range_.other[axis] - range_.corner[axis]);
      at[axis] = range_.outside[axis] + share * (to - range_.outside[axis]);
    }
    return at;
  }

  WanderRange range_;
  std::array<std::array<double, 3>, models::max_law_axes> phase_{};
};

}  // namespace kerf::test
