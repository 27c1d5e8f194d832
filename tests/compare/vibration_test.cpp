#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/compare/compare.h>
#include <kerf/compare/vibration.h>

#include "compare/runs.h"

namespace kerf::compare {
namespace {

using test::run_of;
using test::strokes;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<double> tone(double hz, double amplitude, double rate_hz, std::size_t ticks) {
  std::vector<double> values;
  for (std::size_t i = 0; i < ticks; ++i)
    values.push_back(amplitude * std::cos(2.0 * std::numbers::pi * hz * static_cast<double>(i) / rate_hz));
  return values;
}

TEST(BandLevels, FindTheRmsOfAToneInItsBandAlone) {
  const auto bands = band_levels(tone(250.0, 0.02, 1000.0, 4000), 1000.0, "N");
  ASSERT_EQ(bands.size(), 5U);  // from 20, 40, 80, 160 and 320 Hz
  EXPECT_NEAR(bands[3].rms, 0.02 / std::numbers::sqrt2, 1e-4);
  EXPECT_NEAR(bands[3].worst_rms, 0.02 / std::numbers::sqrt2, 2e-4);
  EXPECT_LT(bands[1].rms, 1e-5);
  EXPECT_EQ(bands[4].to_hz, 500.0);
  // The fastest that there is, each tick by turns, to either side of zero.
  EXPECT_NEAR(band_levels(tone(500.0, 0.024, 1000.0, 4000), 1000.0, "N").back().rms, 0.024, 1e-4);
}

TEST(BandLevels, LeaveOutWhatIsSlowerThanAVibration) {
  for (const BandLevel& band : band_levels(strokes(), 1000.0, "N"))
    EXPECT_LT(band.thresholds(), 1.0) << band.from_hz;
}

TEST(VibrationThreshold, IsLeastWhereFingersAreMostSensitive) {
  EXPECT_DOUBLE_EQ(vibration_threshold(250.0, "N"), 0.003);
  EXPECT_NEAR(vibration_threshold(std::sqrt(20.0 * 40.0), "N"), std::sqrt(0.012 * 0.008), 1e-12);
  EXPECT_DOUBLE_EQ(vibration_threshold(5000.0, "N"), 0.03);
  EXPECT_DOUBLE_EQ(vibration_threshold(250.0, "N·m"), 0.003 * 0.01);
}

// What a broken renderer does, and half a JND let pass: a buzz, and a force that alternates each tick.
TEST(Compare, FeelsVibrationThatNoTickShows) {
  for (const double rate_hz : {1000.0, 333.0}) {
    const std::vector<double> expected = strokes(4000, 1.0 / rate_hz);
    const auto with = [&](const std::vector<double>& added, const Tolerance& tolerance) {
      std::vector<double> got = expected;
      for (std::size_t i = 0; i < added.size(); ++i) got[1500 + i] += added[i];
      return compare(run_of(expected, 1.0 / rate_hz), run_of(got, 1.0 / rate_hz), tolerance);
    };
    const auto buzz = tone(0.25 * rate_hz, 0.02, rate_hz, 500);
    const auto alternating = tone(0.5 * rate_hz, 0.024, rate_hz, 500);
    for (const auto& added : {buzz, alternating}) {
      const Comparison comparison = with(added, {.jnd = 0.5});
      EXPECT_EQ(comparison.outside, 0U);
      EXPECT_THAT(comparison.messages, ElementsAre(HasSubstr("times what a hand can feel")));
      EXPECT_TRUE(with(added, {.jnd = 0.5, .vibration = 100.0}).passed);
    }
    EXPECT_TRUE(with(std::vector<double>(500, 0.02), {.jnd = 0.5}).passed) << "a step is no vibration";
    EXPECT_TRUE(with(buzz, {.force_n = 0.05}).passed) << "nobody asked what a hand feels";
  }
}

}  // namespace
}  // namespace kerf::compare
