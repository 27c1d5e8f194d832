#include "loop/command.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

const std::vector<drivers::AxisInfo> scissors{
    {.name = "theta", .lever = 0.04, .force_limit = 7.0, .slew_limit = 2000.0},
    {.name = "x_s", .lever = 1.0, .force_limit = 100.0, .slew_limit = 20000.0}};

TEST(SafetyLimiter, KeepsEachAxisWithinItsOwnLimit) {
  SafetyLimiter limiter(scissors, 1.0, 0.0);
  Command command{.force = {-9.0, 90.0}};
  limiter.apply(1.0, command);
  EXPECT_EQ(command.force[0], -7.0);
  EXPECT_EQ(command.force[1], 90.0);
  EXPECT_EQ(command.flags, schema::flag_force_limited);
}

TEST(SafetyLimiter, ChangesAForceNoFasterThanItsSlewLimit) {
  SafetyLimiter limiter(scissors, 1e-3, 0.0);
  for (const double expected : {2.0, 4.0, 5.0}) {
    Command command{.force = {5.0}};
    limiter.apply(1.0, command);
    EXPECT_EQ(command.force[0], expected);
    EXPECT_EQ(command.flags, expected < 5.0 ? schema::flag_slew_limited : 0U);
  }
}

TEST(SafetyLimiter, ZeroesEveryAxisOnOneBadNumber) {
  SafetyLimiter limiter(scissors, 1e-3, 0.0);
  Command command{.force = {2.0, 3.0}};
  limiter.apply(1.0, command);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    command = {.force = {2.0, bad}};
    limiter.apply(1.0, command);
    EXPECT_EQ(command.force, drivers::Axes{});
    EXPECT_EQ(command.flags, schema::flag_law_fault);
  }
}

TEST(SafetyLimiter, TrustsNoForceOfALawThatFaulted) {
  SafetyLimiter limiter(scissors, 1e-3, 0.0);
  Command command{.force = {1.0}, .flags = schema::flag_law_fault};
  limiter.apply(1.0, command);
  EXPECT_EQ(command.force[0], 0.0);
}

TEST(PassivityObserver, CountsTheWorkTakenOutOfTheHand) {
  PassivityObserver observer(scissors);
  observer.observe({}, {0.5, 0.0});
  observer.observe({3.0, 0.0},
                   {0.3, 0.0});  // it opens while the hand closes: it takes 3 N x 0.04 m/rad x 0.2 rad
  EXPECT_NEAR(observer.energy_j(), 3.0 * 0.04 * 0.2, 1e-15);
  observer.observe({0.0, -5.0}, {0.3, 0.01});
  EXPECT_NEAR(observer.energy_j(), 0.024 + 0.05, 1e-15);
}

TEST(PassivityObserver, RemembersTheMostThatWasGiven) {
  PassivityObserver observer(scissors);
  observer.observe({}, {0.0, 0.0});
  observer.observe({0.0, 2.0}, {0.0, 0.1});
  observer.observe({0.0, -2.0}, {0.0, 0.3});
  EXPECT_NEAR(observer.least_j(), -0.2, 1e-15);
  EXPECT_NEAR(observer.energy_j(), 0.2, 1e-15);
}

TEST(PassivityObserver, FindsASpringWithoutDelayLossless) {
  PassivityObserver observer(scissors);
  constexpr int steps = 20'000;
  double force = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double x = 0.02 * std::sin(2.0 * std::acos(-1.0) * i / steps);
    observer.observe({0.0, force}, {0.0, x});
    force = -100.0 * x;
  }
  EXPECT_NEAR(observer.energy_j(), 0.0, 1e-4 * 0.5 * 100.0 * 0.02 * 0.02 * 10);
}

TEST(LawRendering, PushesAgainstTheEngagement) {
  const double values[] = {10.0, 1e-9, 1e-9};
  const models::Law spring = models::Law::make("kelvin", values);
  LawRendering closing(spring, {.position = 0.5, .direction = -1.0}, 0);
  LawRendering pressing(spring, {.position = 0.01, .direction = 1.0}, 1);
  drivers::Sample sample;
  sample.position = {0.3, 0.03};
  EXPECT_NEAR(closing(sample, 1e-3).force[0], 10.0 * 0.2, 1e-9) << "blades that close are pushed open";
  EXPECT_NEAR(pressing(sample, 1e-3).force[1], -10.0 * 0.02, 1e-9);
  sample.position = {0.7, 0.0};
  EXPECT_EQ(closing(sample, 1e-3).force[0], 0.0) << "no force before contact";
}

}  // namespace
}  // namespace kerf::bench
