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

/// The handle of the scissors alone: 15 g, 0.2 N·s/m.
const std::vector<drivers::AxisInfo> handle{
    {.name = "x",
     .force_unit = "N",
     .mechanics = drivers::Mechanics{.mass_kg = 0.015, .viscous_n_s_per_m = 0.2}}};
constexpr double period_s = 1e-3;

/// A force that was held from x = 0 over a travel in a period.
PassivityController after_travel(double force_n, double travel_m, double stored_change_j) {
  PassivityController controller(handle, period_s);
  controller.observe({}, period_s, 0.0);
  controller.hold({force_n}, {force_n}, {force_n});
  controller.observe({travel_m}, period_s, stored_change_j);
  return controller;
}

TEST(PassivityController, BooksWhatNeitherWasStoredNorTaken) {
  const double friction_j = 0.2 * 1e-8 / period_s;
  EXPECT_NEAR(after_travel(2.0, 1e-4, 0.0).energy_j(), -2e-4 + friction_j, 1e-15) << "given";
  EXPECT_NEAR(after_travel(2.0, 1e-4, -1.5e-4).energy_j(), -0.5e-4 + friction_j, 1e-15) << "out of the store";
  EXPECT_EQ(after_travel(2.0, -1e-4, 0.0).energy_j(), 0.0) << "a surplus is forgotten";
  EXPECT_EQ(after_travel(2.0, 1e-4, -3e-4).energy_j(), 0.0);
}

TEST(PassivityController, TakesBackInOnePeriodWhatWasGiven) {
  const PassivityController controller = after_travel(0.5, 1e-3, 0.0);
  drivers::Axes force{};
  ASSERT_TRUE(controller.brake(force));
  EXPECT_LT(force[0], 0.0) << "against the motion";
  EXPECT_NEAR(-force[0] * 1e-3, -controller.energy_j(), 1e-15) << "over a millimetre more";
}

TEST(PassivityController, DampsNoMoreThanTheMassBearsInAPeriod) {
  const PassivityController controller = after_travel(100.0, 1e-4, 0.0);
  drivers::Axes force{};
  ASSERT_TRUE(controller.brake(force));
  EXPECT_NEAR(force[0], -0.015 / period_s * 0.1, 1e-12) << "a = m / T, at 0.1 m/s";
  PassivityController unknown({{.name = "x", .force_unit = "N"}}, period_s);
  unknown.observe({}, period_s, 0.0);
  unknown.hold({100.0}, {100.0}, {100.0});
  unknown.observe({1e-4}, period_s, 0.0);
  force = {};
  ASSERT_TRUE(unknown.brake(force));
  EXPECT_NEAR(force[0], -0.01 / period_s * 0.1, 1e-12) << "10 g where nobody knows";
}

TEST(PassivityController, CountsOfTheStoreTheShareThatTheHandGets) {
  PassivityController controller(handle, period_s);
  controller.observe({}, period_s, 0.0);
  controller.hold({-4.0}, {-1.0}, {-1.0});  // cut to a quarter by a limit or a ramp
  controller.observe({1e-4}, period_s, 4e-4);
  EXPECT_EQ(controller.energy_j(), 0.0) << "0.1 mJ were taken and a quarter of 0.4 mJ stored";
}

TEST(PassivityController, LetsACutPayForNothing) {
  for (const bool says_what_it_stores : {true, false}) {
    PassivityController controller(handle, period_s);
    const double stored = says_what_it_stores ? 0.0 : std::nan("");
    double x = 0.0;
    controller.observe({x}, period_s, stored);
    for (int tick = 0; tick < 200; ++tick) {  // 2 N over 20 mm
      controller.hold({-2.0}, {-2.0}, {-2.0});
      controller.observe({x += 1e-4}, period_s, stored);
    }
    controller.hold({}, {}, {});  // out of the tissue
    controller.observe({x}, period_s, stored);
    controller.hold({1.0}, {1.0}, {1.0});
    controller.observe({x + 1e-4}, period_s, stored);
    drivers::Axes force{};
    EXPECT_TRUE(controller.brake(force)) << says_what_it_stores;
  }
}

TEST(PassivityController, DragsNoHandThatLeftTheTissue) {
  PassivityController controller = after_travel(5.0, 1e-3, 0.0);
  ASSERT_LT(controller.energy_j(), 0.0);
  for (int tick = 0; tick < 12; ++tick) {
    controller.hold({}, {}, {});
    controller.observe({1e-3}, period_s, 0.0);
  }
  EXPECT_EQ(controller.energy_j(), 0.0);
}

TEST(PassivityController, LeavesAPassiveRenderingAndAHandAtRestAlone) {
  drivers::Axes force{1.0};
  const PassivityController passive = after_travel(-2.0, 1e-3, 2e-3);
  EXPECT_FALSE(passive.brake(force));
  const PassivityController owing = after_travel(5.0, 9e-8, 0.0);
  ASSERT_LT(owing.energy_j(), 0.0);
  EXPECT_FALSE(owing.brake(force));
  EXPECT_EQ(force[0], 1.0);
}

}  // namespace
}  // namespace kerf::bench
