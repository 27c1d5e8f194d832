#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>

#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

namespace kerf::test {

/// A Kelvin tissue and what is done to it.
struct Tissue {
  double parallel_stiffness = 300.0;  ///< [N/m]; 0: no tissue at all
  double damping = 50.0;              ///< [N·s/m], beside a series stiffness of 500 N/m
  double depth_m = 0.005;
  double seconds = 4.0;
  double noise_n = 0.005;
  std::size_t bad_every = 0;  ///< one in so many samples reads bad_force_n; 0: none
  double bad_force_n = 6.0;
  double limit_n = std::numeric_limits<double>::infinity();  ///< of the sensor
  unsigned seed = 1;
};

/// A recording at 1 kHz of a tool that goes into the tissue and out again, a little faster each time.
inline schema::Recording punch(const Tissue& tissue = {}) {
  const std::array values{std::max(tissue.parallel_stiffness, 1.0), 500.0, tissue.damping};
  const models::Law law = models::Law::make("kelvin", values, {});
  models::Law::State state = law.initial_state();
  std::mt19937 generator(tissue.seed);
  std::normal_distribution<double> normal;  // its deviation must not be 0
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "z", .position_unit = "m", .force_unit = "N"}};
  const auto count = static_cast<std::size_t>(std::lround(1e3 * tissue.seconds));
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = 1e-3 * static_cast<double>(i);
    const double turns = 2.0 * 3.14159265358979 * time_s * (0.5 + 0.25 * time_s);
    const double rate = 2.0 * 3.14159265358979 * (0.5 + 0.5 * time_s);
    const models::Motion motion{.penetration = 0.5 * tissue.depth_m * (1.0 - std::cos(turns)),
                                .velocity = 0.5 * tissue.depth_m * rate * std::sin(turns)};
    const bool bad = tissue.bad_every > 0 && i % tissue.bad_every == tissue.bad_every - 1;
    const double force =
        std::min(law.step(state, motion, 1e-3).force + tissue.noise_n * normal(generator), tissue.limit_n);
    recording.time.push_back(time_s);
    recording.tick.push_back(i);
    recording.position.push_back(motion.penetration);
    recording.velocity.push_back(motion.velocity);
    recording.force_measured.push_back(tissue.parallel_stiffness > 0.0 ? (bad ? tissue.bad_force_n : force)
                                                                       : 0.0);
  }
  return recording;
}

}  // namespace kerf::test
