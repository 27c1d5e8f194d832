#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <kerf/drivers/hand.h>
#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

namespace kerf::test {

/// How a law that is known is recorded.
struct KnownCut {
  double seconds = 10.0;
  double rate_hz = 200.0;
  double depth = 0.4;  ///< of a stroke [rad or m]
  double noise_n = 0.02;
  double encoder_step = 1e-4;  ///< [rad or m]
  const char* position_unit = "rad";
  bool with_cycles = true;
  std::uint64_t seed = 1;
};

/// Closings and openings along strokes of minimum jerk, of varying depth and duration, with a pause at either
/// end; the force of the law with white noise, the position in encoder steps.
inline schema::Recording cut_of(const models::Law& law, const KnownCut& cut = {}) {
  std::mt19937_64 random(cut.seed);
  std::normal_distribution<double> normal;  // its deviation must not be 0
  std::uniform_real_distribution<double> vary(0.8, 1.2);
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "theta",
                     .position_unit = cut.position_unit,
                     .contact_position = 0.0,
                     .contact_direction = 1.0}};
  schema::Cycles cycles;
  models::Law::State state = law.initial_state();
  const double period_s = 1.0 / cut.rate_hz;
  double x_before = 0.0;
  const auto add = [&](double x, double v) {
    const std::size_t row = recording.rows();
    recording.time.push_back(period_s * static_cast<double>(row));
    recording.tick.push_back(row);
    const double seen = cut.encoder_step * std::round(x / cut.encoder_step);
    recording.position.push_back(seen);
    recording.velocity.push_back((seen - x_before) / period_s);
    x_before = seen;
    recording.force_measured.push_back(law.step(state, models::Motion{x, v}, period_s).force +
                                       cut.noise_n * normal(random));
  };
  const auto stroke = [&](std::uint32_t cycle, schema::Phase phase, double from, double to,
                          double duration_s) {
    const std::size_t begin = recording.rows();
    const auto rows = static_cast<std::size_t>(duration_s * cut.rate_hz);
    for (std::size_t i = 0; i < rows; ++i) {
      const auto at = drivers::MinimumJerk::at(static_cast<double>(i) / static_cast<double>(rows));
      add(from + (to - from) * at.position, (to - from) * at.speed / duration_s);
    }
    cycles.phases.push_back({.cycle = cycle, .phase = phase, .begin = begin, .end = recording.rows()});
  };
  for (std::uint32_t cycle = 1; static_cast<double>(recording.rows()) < cut.seconds * cut.rate_hz; ++cycle) {
    const double depth = cut.depth * vary(random);
    stroke(cycle, schema::Phase::open_to_close, 0.0, 0.0, 0.2);
    stroke(cycle, schema::Phase::closing, 0.0, depth, 0.7 * vary(random));
    stroke(cycle, schema::Phase::close_to_open, depth, depth, 0.3);
    stroke(cycle, schema::Phase::opening, depth, 0.0, 0.7 * vary(random));
  }
  if (cut.with_cycles) recording.cycles = cycles;
  return recording;
}

}  // namespace kerf::test
