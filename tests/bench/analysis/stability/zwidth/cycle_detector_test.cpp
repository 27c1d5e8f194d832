#include "stability/zwidth/cycle_detector.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/drivers/gaussian.h>

namespace kerf::bench {
namespace {

constexpr CycleDetector::Options small{
    .ticks = 400, .lowest_bin = 5, .highest_bin = 190, .neighbours = 16, .false_alarms = 0.01};

/// Windows of noise in which a cycle is found, of so many; each value is `share` of the one before and new.
std::size_t false_alarms(std::size_t windows, double share) {
  CycleDetector detector(small);
  drivers::Gaussian noise(7);
  double value = 0.0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < windows; ++i) {
    detector.restart();
    while (!detector.is_full()) detector.add(value = share * value + noise());
    if (detector.judge().is_significant) ++found;
  }
  return found;
}

TEST(CycleDetector, HasAtMostItsRateOfFalseAlarmsInNoise) {
  // Of 10,000 quiet windows 100 at most, +- 3 standard deviations of a count of 100.
  constexpr std::size_t windows = 10'000;
  for (const double share : {0.0, 0.2, -0.2}) {
    const std::size_t found = false_alarms(windows, share);
    EXPECT_LE(found, 130U) << share;
    EXPECT_GE(found, 20U) << share << ": Bonferroni's bound is not far off";
  }
}

TEST(CycleDetector, FindsASineInNoiseWithItsFrequencyAndStrength) {
  CycleDetector detector({.ticks = 1000});
  for (const double bin : {40.0, 40.5, 123.3}) {
    drivers::Gaussian noise(3);
    detector.restart();
    for (int tick = 0; tick < 1000; ++tick)
      detector.add(5.0 + 0.2 * std::sin(2.0 * std::numbers::pi * bin * tick / 1000.0) + 0.1 * noise());
    const FoundCycle found = detector.judge();
    EXPECT_TRUE(found.is_significant);
    EXPECT_NEAR(static_cast<double>(found.bin), bin, 0.6);
    EXPECT_NEAR(found.rms, 0.2 / std::numbers::sqrt2, 0.01);
  }
}

TEST(CycleDetector, IsNotMovedByWhatAHandDoes) {
  CycleDetector detector({.ticks = 1000});
  drivers::Gaussian noise(5);
  for (int tick = 0; tick < 1000; ++tick)
    detector.add(3.0 * std::sin(2.0 * std::numbers::pi * 0.7 * tick / 1000.0) + 0.01 * noise());
  EXPECT_LT(detector.judge().rms, 0.02);
}

TEST(CycleDetector, FindsNothingWhereNothingMoves) {
  CycleDetector detector({.ticks = 200, .highest_bin = 90});
  for (int tick = 0; tick < 199; ++tick) detector.add(2.5);
  EXPECT_FALSE(detector.judge().is_significant) << "its window is not full";
  detector.add(2.5);
  EXPECT_TRUE(detector.is_full());
  EXPECT_FALSE(detector.judge().is_significant);
}

TEST(CycleDetector, HasTheThresholdOfItsDistribution) {
  // SciPy: stats.f.isf(0.01 / 186, 2, 32) = 13.5777
  EXPECT_NEAR(CycleDetector(small).threshold(), 13.5777, 1e-4);
}

TEST(CycleDetector, RefusesBandsThatAreNotInItsWindow) {
  EXPECT_THROW(CycleDetector({.ticks = 50}), std::invalid_argument);
  EXPECT_THROW(CycleDetector({.ticks = 200, .highest_bin = 120}), std::invalid_argument);
  EXPECT_THROW(CycleDetector({.ticks = 200, .lowest_bin = 70, .highest_bin = 90}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
