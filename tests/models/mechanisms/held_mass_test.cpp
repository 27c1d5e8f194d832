#include "kerf/mechanisms/held_mass.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::mechanisms {
namespace {

constexpr HeldMass uneven{.mass_kg = 0.2, .coulomb_up_n = 0.1, .coulomb_down_n = 0.3};

TEST(HeldMass, IsStoppedByTheFrictionOfTheDirectionInWhichItMoves) {
  // m v^2 / 2 = f_c x
  const AxisMotion up = uneven.after({.speed_m_s = 0.05}, 0.0, 0.5);
  EXPECT_EQ(up.speed_m_s, 0.0);
  EXPECT_NEAR(up.position_m, 0.5 * 0.2 * 0.05 * 0.05 / 0.1, 1e-9);
  const AxisMotion down = uneven.after({.speed_m_s = -0.05}, 0.0, 0.5);
  EXPECT_EQ(down.speed_m_s, 0.0);
  EXPECT_NEAR(down.position_m, -0.5 * 0.2 * 0.05 * 0.05 / 0.3, 1e-9);
}

TEST(HeldMass, StaysWhileTheForceIsWithinTheFrictionOfItsDirection) {
  EXPECT_EQ(uneven.after({}, 0.0999, 0.01).speed_m_s, 0.0);
  EXPECT_EQ(uneven.after({}, -0.2999, 0.01).speed_m_s, 0.0);
  EXPECT_NEAR(uneven.after({}, 0.2, 0.01).speed_m_s, (0.2 - 0.1) / 0.2 * 0.01, 1e-15);
  EXPECT_NEAR(uneven.after({}, -0.5, 0.01).speed_m_s, -(0.5 - 0.3) / 0.2 * 0.01, 1e-15);
}

TEST(HeldMass, GoesBackUnderTheFrictionOfTheOtherDirection) {
  // Forward under 0.5 + 0.1 N until v = 0, then back under 0.5 - 0.3 N.
  const double there_s = 0.001 * 0.2 / 0.6;
  const AxisMotion end = uneven.after({.speed_m_s = 0.001}, -0.5, 1e-3);
  EXPECT_NEAR(end.speed_m_s, -0.2 / 0.2 * (1e-3 - there_s), 1e-7);
}

TEST(HeldMass, MovesAlikeWhetherItsExponentialsAreKeptOrMadeOnTheWay) {
  const HeldMass held{.mass_kg = 0.25,
                      .damping_n_s_per_m = 5.0,
                      .stiffness_n_per_m = 500.0,
                      .coulomb_up_n = 0.1,
                      .coulomb_down_n = 0.2};
  const HeldMassMotion kept(held, 7e-4);
  AxisMotion at{.position_m = 0.01};
  for (int i = 0; i < 2000; ++i) {
    const double force_n = std::sin(0.05 * i);
    const AxisMotion made = held.after(at, force_n, 7e-4);
    at = kept.after(at, force_n);
    ASSERT_EQ(at.position_m, made.position_m);
    ASSERT_EQ(at.speed_m_s, made.speed_m_s);
  }
}

}  // namespace
}  // namespace kerf::mechanisms
