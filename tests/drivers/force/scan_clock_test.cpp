#include "kerf/drivers/scan_clock.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/allocation_counter.h"

namespace kerf::drivers {
namespace {

constexpr double period_s = 1e-3;

/// Scan n of a device whose millisecond is `drift_ppm` longer than the host's, which began at 5 s.
std::int64_t taken_ns(std::uint64_t scan, double drift_ppm) {
  return 5'000'000'000 + std::llround(1e6 * (1.0 + 1e-6 * drift_ppm) * static_cast<double>(scan));
}

TEST(ScanClock, FindsTheLineOfAClockWithoutDelaysExactly) {
  for (const double drift_ppm : {80.0, -80.0, 0.0}) {
    ScanClock clock(period_s);
    for (std::uint64_t scan = 0; scan < 10'000; ++scan) clock.add(scan, taken_ns(scan, drift_ppm));
    EXPECT_NEAR(clock.drift_ppm(), drift_ppm, 1e-3);
    EXPECT_LT(clock.drift_error_ppm(), 1e-3);
    EXPECT_NEAR(static_cast<double>(clock.time_ns(9'999) - taken_ns(9'999, drift_ppm)), 0.0, 3.0);
  }
}

TEST(ScanClock, IsWithinItsOwnErrorWhateverTheDelays) {
  // Delays of 0.1 ms on average, exponentially distributed, and for one second in ten 20 ms more.
  unsigned within = 0;
  double worst_10_s = 0.0;
  double worst_60_s = 0.0;
  constexpr unsigned seeds = 40;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> delay_ns(1e-5);
    ScanClock clock(period_s);
    for (std::uint64_t scan = 0; scan < 60'000; ++scan) {
      const double held_up_ns = scan / 1000 % 10 == 3 ? 20e6 : 0.0;
      clock.add(scan, taken_ns(scan, 80.0) + std::llround(delay_ns(random) + held_up_ns));
      if (scan == 9'999) worst_10_s = std::max(worst_10_s, std::abs(clock.drift_ppm() - 80.0));
    }
    const double error = std::abs(clock.drift_ppm() - 80.0);
    worst_60_s = std::max(worst_60_s, error);
    if (error <= clock.drift_error_ppm()) ++within;
    EXPECT_NEAR(static_cast<double>(clock.time_ns(59'999) - taken_ns(59'999, 80.0)), 0.0, 20e3);
  }
  EXPECT_LT(worst_10_s, 5.0);
  EXPECT_LT(worst_60_s, 1.0);
  EXPECT_GE(within, 9 * seeds / 10);
}

TEST(ScanClock, NeverPutsAScanAfterItsArrival) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> delay_ns(0.0, 1e6);
  ScanClock clock(period_s);
  for (std::uint64_t scan = 0; scan < 20'000; ++scan) {
    const std::int64_t arrived_ns = taken_ns(scan, -80.0) + std::llround(delay_ns(random));
    clock.add(scan, arrived_ns);
    ASSERT_LE(clock.time_ns(scan), arrived_ns + 1) << scan;
  }
}

TEST(ScanClock, KnowsTheTimeToATenthOfAMillisecondFromTheFirstScanOn) {
  for (const double drift_ppm : {80.0, -80.0}) {
    ScanClock clock(period_s);
    for (std::uint64_t scan = 0; scan < 3'000; ++scan) {
      clock.add(scan, taken_ns(scan, drift_ppm));
      ASSERT_LE(std::abs(static_cast<double>(clock.time_ns(scan) - taken_ns(scan, drift_ppm))), 100e3)
          << scan;
    }
  }
}

TEST(ScanClock, FollowsAClockThatChangesWithin64Seconds) {
  ScanClock clock(period_s);
  std::int64_t now_ns = 0;
  for (std::uint64_t scan = 0; scan < 200'000; ++scan) {
    now_ns += scan < 100'000 ? 1'000'040 : 1'000'020;
    clock.add(scan, now_ns);
  }
  EXPECT_NEAR(clock.drift_ppm(), 20.0, 0.01);
}

TEST(ScanClock, FollowsARateThatWasToldWrongWhereItMay) {
  constexpr double drift_ppm = 20'000.0;
  ScanClock clock(0.01, 0.03);
  const auto taken = [&](std::uint64_t scan) {
    return 5'000'000'000 + std::llround(1e7 * (1.0 + 1e-6 * drift_ppm) * static_cast<double>(scan));
  };
  for (std::uint64_t scan = 0; scan < 1'000; ++scan) {
    clock.add(scan, taken(scan));
    if (scan < 150) continue;
    ASSERT_NEAR(static_cast<double>(clock.time_ns(scan) - taken(scan)), 0.0, 100.0) << scan;
  }
  EXPECT_NEAR(clock.drift_ppm(), drift_ppm, 0.01);
}

TEST(ScanClock, KeepsItsDriftWhenTheScansBeginAnew) {
  ScanClock clock(period_s);
  for (std::uint64_t scan = 0; scan < 5'000; ++scan) clock.add(scan, taken_ns(scan, 80.0));
  clock.restart();
  // Half a period off, 300 scans later.
  clock.add(5'300, taken_ns(5'300, 80.0) + 500'000);
  EXPECT_NEAR(clock.drift_ppm(), 80.0, 0.01);
  EXPECT_NEAR(static_cast<double>(clock.time_ns(5'400) - taken_ns(5'400, 80.0)), 500'000.0, 3.0);
}

TEST(ScanClock, AllocatesNothing) {
  ScanClock clock(period_s);
  const test::NoAllocation guard;
  for (std::uint64_t scan = 0; scan < 100'000; ++scan) clock.add(scan, taken_ns(scan, 10.0));
}

}  // namespace
}  // namespace kerf::drivers
