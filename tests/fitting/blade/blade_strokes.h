#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <kerf/fitting/blade.h>

namespace kerf::test {

/// A tool that sways along six axes, each with a frequency of its own, and the generalised forces that a law
/// `blade` gives there at 1 kHz, with white noise.
struct BladeStrokes {
  std::vector<double> time_s, position, velocity, force;

  struct Options {
    double seconds = 4.0;
    std::array<double, 6> reach{0.02, 0.02, 0.01, 0.25, 0.25, 0.25};  ///< amplitudes [m, rad]
    double height_m = 0.0;                                            ///< mean z of the hand point
    double noise_n = 0.0;
    double noise_n_m = 0.0;
    std::uint64_t seed = 1;
  };

  BladeStrokes(const models::Law& law, const Options& options) {
    constexpr std::array frequency_hz{0.73, 1.1, 0.47, 0.89, 0.61, 1.3};
    std::mt19937_64 random(options.seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    models::Law::State state = law.initial_state();
    const auto rows = static_cast<std::size_t>(1000.0 * options.seconds);
    for (std::size_t i = 0; i < rows; ++i) {
      time_s.push_back(1e-3 * static_cast<double>(i));
      models::SpatialMotion motion;
      for (std::size_t axis = 0; axis < 6; ++axis) {
        const double rate = 2.0 * 3.141592653589793 * frequency_hz[axis];
        const double angle = rate * time_s.back() + static_cast<double>(axis);
        motion.position[axis] = options.reach[axis] * std::sin(angle) + (axis == 2 ? options.height_m : 0.0);
        motion.velocity[axis] = options.reach[axis] * rate * std::cos(angle);
        position.push_back(motion.position[axis]);
        velocity.push_back(motion.velocity[axis]);
      }
      const auto felt = law.step(state, motion, 1e-3);
      for (std::size_t axis = 0; axis < 6; ++axis) {
        force.push_back(felt.force[axis] + (axis < 3 ? options.noise_n : options.noise_n_m) * normal(random));
      }
    }
  }

  [[nodiscard]] fitting::BladeSeries series() const {
    return {.time_s = time_s, .position = position, .velocity = velocity, .force = force};
  }
};

/// 10 mm wide, 30 mm long, the hand point at its upper end, the edge ahead on x.
inline const models::Options scalpel{
    {"polygons", std::string("-0.005 0 -0.03, 0.005 0 -0.03, 0.005 0 0, -0.005 0 0")},
    {"edge", std::string("0.005 0 -0.03, 0.005 0 0")}};

inline models::Options with(models::Options options, const std::string& name, models::OptionValue value) {
  options[name] = std::move(value);
  return options;
}

}  // namespace kerf::test
