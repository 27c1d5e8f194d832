#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <kerf/compare/series.h>

namespace kerf::test {

/// A run of one channel.
inline compare::Series run_of(std::vector<double> force, double period_s = 1e-3,
                              const std::string& unit = "N") {
  return {.period_s = period_s, .channels = {{.name = "theta", .unit = unit, .value = std::move(force)}}};
}

/// Strokes with a force of up to 3 N, and none in between.
inline std::vector<double> strokes(std::size_t ticks = 4000, double seconds_a_tick = 1e-3) {
  std::vector<double> force;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double depth =
        std::sin(2.0 * std::numbers::pi * 1.3 * seconds_a_tick * static_cast<double>(i)) - 0.2;
    force.push_back(depth > 0.0 ? 3.0 * depth * depth / 0.64 : 0.0);
  }
  return force;
}

/// Forces and torques of a tool that wanders.
inline compare::Series six_axes(std::size_t ticks = 1500) {
  compare::Series run;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    compare::Channel channel{.name = std::vector<std::string>{"x", "y", "z", "rx", "ry", "rz"}[axis],
                             .unit = axis < 3 ? "N" : "N·m"};
    for (std::size_t i = 0; i < ticks; ++i) {
      const double t = 1e-3 * static_cast<double>(i);
      const double hz = 0.7 + 0.31 * static_cast<double>(axis);
      channel.value.push_back((axis < 3 ? 2.0 : 0.02) *
                              (std::sin(2.0 * std::numbers::pi * hz * t + static_cast<double>(axis)) +
                               0.3 * std::sin(2.0 * std::numbers::pi * 2.9 * hz * t)));
    }
    run.channels.push_back(std::move(channel));
  }
  return run;
}

/// The same numbers on every machine.
inline std::vector<double> noise(std::size_t ticks, double size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<double> values;
  for (std::size_t i = 0; i < ticks; ++i) {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random()) / 4294967296.0;
    values.push_back(size * sum);
  }
  return values;
}

}  // namespace kerf::test
