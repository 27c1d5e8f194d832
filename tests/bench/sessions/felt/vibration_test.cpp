#include "felt/vibration.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr double rate_hz = 1000.0;

/// Strokes of 3 N at 1 Hz, and on them a sine of so much [N].
std::vector<double> sine_on_strokes(double frequency_hz, double amplitude_n, std::size_t ticks = 4096) {
  std::vector<double> force;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const double turns = static_cast<double>(tick) / rate_hz;
    force.push_back(3.0 * std::sin(2.0 * std::numbers::pi * turns) +
                    amplitude_n * std::sin(2.0 * std::numbers::pi * frequency_hz * turns));
  }
  return force;
}

FeltLevel vibration_of(const std::vector<double>& force, std::size_t axes = 1) {
  VibrationMeter meter(axes, rate_hz);
  meter.add(force);
  FeltLevel level;
  meter.put_into(level);
  return level;
}

TEST(Vibration, IsTheRmsOfWhatIsFasterThanStrokes) {
  const FeltLevel level = vibration_of(sine_on_strokes(200.0, 0.1));
  EXPECT_NEAR(level.vibration_n, 0.1 / std::numbers::sqrt2, 1e-3);
  EXPECT_NEAR(level.vibration_thresholds, 0.1 / std::numbers::sqrt2 / 0.003, 1.0)
      << "3 mN are felt between 160 and 250 Hz";
  EXPECT_LT(vibration_of(sine_on_strokes(200.0, 0.0)).vibration_n, 2e-3);
  EXPECT_LT(vibration_of(sine_on_strokes(8.0, 0.1)).vibration_n, 5e-3) << "below 20 Hz";
}

TEST(Vibration, AddsTheSquaresOfAxesAndWeighsStretchesByTheirLength) {
  const std::vector<double> one = sine_on_strokes(200.0, 0.1);
  std::vector<double> two;
  for (const double force : one) two.insert(two.end(), {force, force});
  EXPECT_NEAR(vibration_of(two, 2).vibration_n, 0.1, 2e-3);
  VibrationMeter meter(1, rate_hz);
  meter.add(one);
  meter.add(std::vector<double>(3 * one.size(), 0.0));
  FeltLevel level;
  meter.put_into(level);
  EXPECT_NEAR(level.vibration_n, 0.05 / std::numbers::sqrt2, 1e-3) << "a quarter of the time";
}

TEST(Vibration, IsNotKnownOfLessThanAWindow) {
  EXPECT_TRUE(std::isnan(vibration_of(sine_on_strokes(200.0, 0.1, 200)).vibration_n));
}

TEST(Vibration, TellsTwoApartWhereAHandFeelsOneAndTheyDifferByThreeDecibels) {
  const auto apart = [](double first_n, double second_n, double thresholds) {
    return is_vibration_apart(felt_apart({.vibration_n = first_n, .vibration_thresholds = thresholds},
                                         {.vibration_n = second_n, .vibration_thresholds = 0.5}));
  };
  EXPECT_TRUE(apart(0.1, 0.07, 2.0));
  EXPECT_FALSE(apart(0.1, 0.08, 2.0));
  EXPECT_FALSE(apart(0.1, 0.01, 0.9)) << "nobody feels either";
  EXPECT_TRUE(apart(0.1, 0.0, 2.0));
  EXPECT_FALSE(apart(0.0, 0.0, 0.0));
}

TEST(FeltLevels, AreApartInJndsOfTheirMean) {
  const FeltApart apart =
      felt_apart({.rms_n = 3.0, .peak_n = 0.1, .limited_share = 0.02}, {.rms_n = 3.3, .peak_n = 0.05});
  EXPECT_NEAR(apart.rms_jnds, 0.3 / (0.07 * 3.15), 1e-12);
  EXPECT_NEAR(apart.peak_jnds, -1.0, 1e-12) << "of weak forces 0.05 N";
  EXPECT_FALSE(is_limit_apart(apart)) << "not known of the second";
}

}  // namespace
}  // namespace kerf::bench
