#include "replay/force_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "replay/force_events.h"

namespace kerf::bench {
namespace {

constexpr std::size_t rows = 8000;

/// Strokes of up to 3 N over eight seconds at 1 kHz; every 500 ms a rupture takes half of the force, if it
/// may.
double cut_at(std::size_t row, bool ruptures) {
  const double time_s = 1e-3 * static_cast<double>(row);
  const double smooth = 2.0 - std::cos(3.0 * time_s);
  return ruptures && row % 500 >= 250 ? 0.5 * smooth : smooth;
}

/// A sensor with a new value every so many rows.
std::vector<double> sensed(double noise, std::size_t held, bool ruptures = false) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> rough;
  std::vector<double> force;
  for (std::size_t row = 0; row < rows; row += held) {
    const double value = cut_at(row, ruptures) + noise * rough(random);
    for (std::size_t i = 0; i < held; ++i) force.push_back(value);
  }
  return force;
}

std::vector<double> in_steps(std::vector<double> force, double quantum) {
  for (double& one : force) one = quantum * std::round(one / quantum);
  return force;
}

/// Straight lines from each new value to the next.
std::vector<double> drawn_out(std::vector<double> force, std::size_t held) {
  for (std::size_t row = 0; row + held < force.size(); ++row) {
    if (row % held == 0) continue;
    const double begin = force[row - row % held];
    const double share = static_cast<double>(row % held) / static_cast<double>(held);
    force[row] = begin + share * (force[row - row % held + held] - begin);
  }
  return force;
}

std::size_t drops_of(const std::vector<double>& force) {
  std::vector<double> times;
  for (std::size_t row = 0; row < force.size(); ++row) times.push_back(1e-3 * static_cast<double>(row));
  const auto events = find_force_events(times, force, {.jnd = {.weber_fraction = 0.07, .threshold = 0.05}});
  return static_cast<std::size_t>(std::ranges::count(events, ForceEventKind::drop, &ForceEvent::kind));
}

TEST(ForceNoise, IsThatOfTheSensorHoweverItsRowsWereFilled) {
  for (const std::size_t held : {1U, 4U, 10U}) {
    EXPECT_NEAR(noise_of(sensed(0.03, held)), 0.03, 0.006) << held;
    EXPECT_NEAR(noise_of(drawn_out(sensed(0.03, held), held)), 0.03, 0.006) << held;
  }
}

TEST(ForceNoise, HasTheQuantumOfCoarseStepsInIt) {
  for (const double noise : {0.0, 0.005, 0.02}) {
    const double both = std::hypot(noise, 0.06 / std::sqrt(12.0));
    EXPECT_GT(noise_of(in_steps(sensed(noise, 1), 0.06)), 0.06 / std::sqrt(12.0) - 1e-9) << noise;
    EXPECT_LT(noise_of(in_steps(sensed(noise, 1), 0.06)), 1.6 * both) << noise;
  }
}

TEST(ForceNoise, IsNoneOfARenderedForce) {
  std::vector<double> force;
  for (std::size_t row = 0; row < rows; ++row) force.push_back(std::max(0.0, cut_at(row, true) - 1.5));
  EXPECT_LT(noise_of(force), 1e-4);
  EXPECT_EQ(noise_of({}), 0.0);
}

TEST(ForceNoise, MakesNoDropsAndHidesNone) {
  EXPECT_EQ(drops_of(in_steps(sensed(0.005, 1), 0.06)), 0U);
  EXPECT_EQ(drops_of(in_steps(sensed(0.02, 1), 0.06)), 0U);
  EXPECT_EQ(drops_of(sensed(0.03, 10)), 0U);
  EXPECT_EQ(drops_of(drawn_out(sensed(0.03, 4), 4)), 0U);
  EXPECT_EQ(drops_of(sensed(0.01, 1, true)), 16U);
  EXPECT_EQ(drops_of(in_steps(sensed(0.02, 1, true), 0.06)), 16U);
  EXPECT_EQ(drops_of(sensed(0.02, 10, true)), 16U);
  EXPECT_EQ(drops_of(drawn_out(sensed(0.02, 4, true), 4)), 16U);
}

}  // namespace
}  // namespace kerf::bench
