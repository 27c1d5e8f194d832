#include "devices/free_tip.h"

#include <string>

#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

namespace kerf::emulators {
namespace {

// Expected numbers by scipy.integrate.solve_ivp, rtol 1e-12, of 0.2 kg, 0.5 N·s/m and 0.1 N.
constexpr FreeTip::Options usual{.delay_s = 0.003};

TEST(FreeTip, MovesAsTheEquationSays) {
  FreeTip tip(usual);
  tip.push({1.0, -1.0, 0.0});
  tip.run_until(0.1);
  tip.push({0.0, 0.0, 0.0});
  tip.run_until(0.103);
  EXPECT_NEAR(tip.travel().x(), 0.02073656, 1e-8);
  EXPECT_NEAR(tip.travel().y(), -0.02073656, 1e-8);
  EXPECT_EQ(tip.travel().z(), 0.0);
}

TEST(FreeTip, TurnsRoundThroughItsFriction) {
  FreeTip tip({.delay_s = 0.003, .max_travel_m = 1.0});
  tip.push({1.0, 0.0, 0.0});
  tip.run_until(0.1);
  tip.push({-1.0, 0.0, 0.0});
  tip.run_until(0.16953823972505241);
  EXPECT_NEAR(tip.travel().x(), 0.0336158726, 1e-10);
  tip.run_until(0.25);
  EXPECT_NEAR(tip.travel().x(), 0.01997867, 1e-8);
}

TEST(FreeTip, ComesToRestByItsFrictionAndStays) {
  FreeTip tip({.delay_s = 0.003, .max_travel_m = 1.0});
  tip.push({1.0, 0.0, 0.0});
  tip.run_until(0.1);
  tip.push({0.0, 0.0, 0.0});
  for (int tick = 100; tick < 1000; ++tick) tip.run_until(1e-3 * tick);
  EXPECT_NEAR(tip.travel().x(), 0.0923569157, 1e-9);
  tip.push({0.0999, 0.0, 0.0});
  tip.run_until(2.0);
  EXPECT_NEAR(tip.travel().x(), 0.0923569157, 1e-9);
}

TEST(FreeTip, IsStillUntilTheDelayHasPassed) {
  FreeTip tip(usual);
  tip.run_until(1.0);
  tip.push({1.0, 0.0, 0.0});
  tip.run_until(1.003);
  EXPECT_EQ(tip.travel().x(), 0.0);
  tip.run_until(1.004);
  EXPECT_GT(tip.travel().x(), 0.0);
}

TEST(FreeTip, LeavesItsStopOnlyWhereItIsPulledOff) {
  FreeTip tip(usual);
  tip.push({5.0, 0.0, 0.0});
  tip.run_until(1.0);
  EXPECT_EQ(tip.travel().x(), 0.04);
  tip.push({-5.0, 0.0, 0.0});
  tip.run_until(1.01);
  EXPECT_LT(tip.travel().x(), 0.04);
}

TEST(FreeTip, IsOnlyOfADeviceThatNobodyHolds) {
  const auto parsed = [](const std::string& uri) {
    drivers::UriOptions given(drivers::parse_uri(uri));
    return FreeTip::in(given);
  };
  EXPECT_FALSE(parsed("falcon"));
  EXPECT_EQ(parsed("falcon?hand=off&delay=1.5ms&mass=0.1kg")->delay_s, 0.0015);
  EXPECT_THROW((void)parsed("falcon?delay=1.5ms"), drivers::DeviceError);
}

}  // namespace
}  // namespace kerf::emulators
