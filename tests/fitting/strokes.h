#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include <kerf/fitting/fit.h>

namespace kerf::test {

/// Penetration along smooth strokes, and the force that a law gives there, with white noise.
struct Strokes {
  std::vector<double> time_s, penetration, velocity, force;
  std::vector<std::uint32_t> cycle;

  Strokes(std::size_t samples, double noise_n, const models::Law& law, std::uint64_t seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    models::Law::State state = law.initial_state();
    constexpr double period_s = 1e-3;
    constexpr double frequency = 4.0;  // [rad/s]
    for (std::size_t i = 0; i < samples; ++i) {
      const double phase = frequency * period_s * static_cast<double>(i);
      time_s.push_back(period_s * static_cast<double>(i));
      penetration.push_back(0.2 * (1.0 - std::cos(phase)));
      velocity.push_back(0.2 * frequency * std::sin(phase));
      cycle.push_back(1 + static_cast<std::uint32_t>(phase / 6.283185307179586));
      force.push_back(law.step(state, models::Motion{penetration.back(), velocity.back()}, period_s).force +
                      noise_n * normal(random));
    }
  }

  [[nodiscard]] fitting::Series series(bool with_cycles = false) const {
    return {.time_s = time_s,
            .penetration = penetration,
            .velocity = velocity,
            .force = force,
            .cycle = with_cycles ? std::span<const std::uint32_t>(cycle) : std::span<const std::uint32_t>()};
  }
};

}  // namespace kerf::test
