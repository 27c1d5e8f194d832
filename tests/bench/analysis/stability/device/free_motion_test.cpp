#include "stability/device/free_motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr SampledDevice handle{.mass_kg = 0.2, .viscous_n_s_per_m = 0.5};

TEST(FreeMotion, IsTheClosedFormOfAMassWithFriction) {
  const double time_s = 1e-3;
  const AxisMotion end = FreeMotion(handle, time_s).after({.position_m = 0.01, .speed_m_s = 0.3}, 2.0);
  const double rate = 0.5 / 0.2;
  const double settled = 2.0 / 0.5;
  const double speed = settled + (0.3 - settled) * std::exp(-rate * time_s);
  EXPECT_NEAR(end.speed_m_s, speed, 1e-14);
  EXPECT_NEAR(end.position_m, 0.01 + settled * time_s - (0.3 - settled) / rate * std::expm1(-rate * time_s),
              1e-14);
}

TEST(FreeMotion, IsTheClosedFormOfASpringInAHand) {
  SampledDevice held{.mass_kg = 0.1, .viscous_n_s_per_m = 0.0};
  held.hand = {.mass_kg = 0.15, .damping_n_s_per_m = 0.0, .stiffness_n_per_m = 400.0};
  const double rate = std::sqrt(400.0 / 0.25);
  const AxisMotion end = FreeMotion(held, 0.05).after({.position_m = 0.002}, 0.0);
  EXPECT_NEAR(end.position_m, 0.002 * std::cos(rate * 0.05), 1e-14);
  EXPECT_NEAR(end.speed_m_s, -0.002 * rate * std::sin(rate * 0.05), 1e-13);
}

TEST(FreeMotion, EndsAtRestWhereCoulombFrictionHasTakenAllItsEnergy) {
  SampledDevice dry{.mass_kg = 0.2, .viscous_n_s_per_m = 0.0, .coulomb_n = 0.1};
  const FreeMotion tick(dry, 1e-3);
  AxisMotion at{.speed_m_s = 0.05};
  for (int i = 0; i < 200; ++i) at = tick.after(at, 0.0);
  EXPECT_EQ(at.speed_m_s, 0.0);
  EXPECT_NEAR(at.position_m, 0.5 * 0.2 * 0.05 * 0.05 / 0.1, 1e-9) << "m v^2 / 2 = f_c x";
}

TEST(FreeMotion, SticksUntilTheForceIsGreaterThanTheFriction) {
  SampledDevice dry{.mass_kg = 0.2, .viscous_n_s_per_m = 0.0, .coulomb_n = 0.1};
  const FreeMotion tick(dry, 1e-3);
  EXPECT_EQ(tick.after({}, 0.0999).speed_m_s, 0.0);
  EXPECT_NEAR(tick.after({}, 0.3).speed_m_s, (0.3 - 0.1) / 0.2 * 1e-3, 1e-15);
  EXPECT_NEAR(tick.after({}, -0.3).speed_m_s, -1e-3, 1e-15);
}

TEST(FreeMotion, TurnsRoundWithinATickUnderTheFrictionOfTheOtherSign) {
  SampledDevice dry{.mass_kg = 0.2, .viscous_n_s_per_m = 0.0, .coulomb_n = 0.1};
  // Forward under 0.5 + 0.1 N until v = 0, then back under 0.5 - 0.1 N.
  const double there_s = 0.001 * 0.2 / 0.6;
  const AxisMotion end = FreeMotion(dry, 1e-3).after({.speed_m_s = 0.001}, -0.5);
  EXPECT_NEAR(end.speed_m_s, -0.4 / 0.2 * (1e-3 - there_s), 1e-7);
}

}  // namespace
}  // namespace kerf::bench
