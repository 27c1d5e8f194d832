#include "loop/passivity.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

const std::vector<drivers::AxisInfo> scissors{
    {.name = "theta", .lever = 0.04, .force_limit = 7.0, .slew_limit = 2000.0},
    {.name = "x_s", .lever = 1.0, .force_limit = 100.0, .slew_limit = 20000.0}};

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

TEST(PassivityController, TakesBackInOnePeriodWhatWasGiven) {
  PassivityObserver observer(scissors);
  observer.observe({}, {0.0, 0.0});
  observer.observe({0.0, 2.0}, {0.0, 0.001});  // pushes along its own motion: gives 2 mJ
  constexpr double period_s = 1e-3;
  const drivers::Axes velocity{0.5, 0.1};  // 0.02 m/s and 0.1 m/s of travel
  drivers::Axes force{};
  ASSERT_TRUE(observer.control(velocity, period_s, force));
  const double taken_j = -period_s * (force[0] * 0.04 * velocity[0] + force[1] * velocity[1]);
  EXPECT_NEAR(taken_j, 2e-3, 1e-15);
  EXPECT_LT(force[0], 0.0) << "against the motion of each axis";
  EXPECT_LT(force[1], 0.0);
}

TEST(PassivityController, LeavesAPassiveRenderingAndAHandAtRestAlone) {
  PassivityObserver observer(scissors);
  observer.observe({}, {0.0, 0.0});
  observer.observe({0.0, -2.0}, {0.0, 0.001});
  drivers::Axes force{1.0, 1.0};
  EXPECT_FALSE(observer.control({1.0, 1.0}, 1e-3, force));
  observer.observe({0.0, 5.0}, {0.0, 0.002});
  EXPECT_LT(observer.energy_j(), 0.0);
  EXPECT_FALSE(observer.control({1e-4, 5e-5}, 1e-3, force));
  EXPECT_EQ(force[0], 1.0);
}

}  // namespace
}  // namespace kerf::bench
