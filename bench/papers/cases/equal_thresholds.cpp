#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include <kerf/drivers/gaussian.h>
#include <kerf/models/two_thresholds.h>

#include "cases/each_case.h"
#include "cases/trace.h"

namespace kerf::bench::cases::equal_thresholds {
namespace {

constexpr double noise_n = 0.02;  // the force sensor of sim:scissors
constexpr double threshold_n = 0.5;
constexpr double gap_n = 0.2;
constexpr double seconds = 2.0;
constexpr double period_s = 1e-3;
constexpr double peak_n = 1.0;

struct Ramp {
  unsigned transitions = 0;
  CaseTrace state;  ///< 0 holds, 1 cuts
};

/// The force rises through the thresholds once and falls through them once, with the sensor's noise.
Ramp up_and_down(const models::TwoThresholds& machine, double above, std::uint64_t seed) {
  drivers::Gaussian noise(seed);
  models::TwoThresholds::State state;
  Ramp ramp;
  const auto ticks = static_cast<int>(seconds / period_s);
  for (int tick = 0; tick < ticks; ++tick) {
    const double time_s = tick * period_s;
    const double force_n = peak_n * (1.0 - std::abs(2.0 * time_s / seconds - 1.0));
    const bool cuts = machine.step(state, force_n + noise_n * noise());
    ramp.state.add(time_s, above + (cuts ? 1.0 : 0.0));
  }
  ramp.transitions = state.transitions;
  return ramp;
}

CaseOutcome judged(const Ramp& ramp) {
  return {.holds = ramp.transitions <= 2,
          .measured = static_cast<double>(ramp.transitions),
          .unit = "transitions",
          .figure = fmt::format("{} transitions", ramp.transitions)};
}

}  // namespace

NamedCase run(std::uint64_t seed) {
  const Ramp failing = up_and_down({.release_n = threshold_n, .rupture_n = threshold_n}, 1.5, seed);
  const Ramp holding = up_and_down(
      {.release_n = threshold_n - 0.5 * gap_n, .rupture_n = threshold_n + 0.5 * gap_n}, 0.0, seed);
  Chart picture = two_traces("The force rises through the thresholds and falls again", failing.state,
                             "equal thresholds", holding.state, "a gap of 0.2 N");
  picture.y_label = "state";
  picture.y_ticks = {{0.0, "holds"}, {1.0, "cuts"}, {1.5, "holds"}, {2.5, "cuts"}};
  picture.y_range = {-0.3, 3.3};
  picture.x_range = {0.35, 1.65};
  const double step_n = 2.0 * peak_n / seconds * period_s;
  const double expected = 4.0 * noise_n / (std::sqrt(std::numbers::pi) * step_n);
  return {
      .where = "[Henry2004], section 3.5",
      .what =
          "With one threshold for breaking in and for letting go, the noise of the force alone makes "
          "the tissue alternate between holding and being cut.",
      .remedy = fmt::format("Two thresholds, {} N apart: ten times the noise.", gap_n),
      .limit = 2.0,
      .quantity = "transitions while the force passes the thresholds once up and once down",
      .without = judged(failing),
      .with = judged(holding),
      .theory = fmt::format("4 s / (sqrt(pi) dF) = {:.0f} transitions are expected of noise s = {} N and a "
                            "force that moves by dF = {:g} N a tick.",
                            expected, noise_n, step_n),
      .picture = std::move(picture)};
}

}  // namespace kerf::bench::cases::equal_thresholds
