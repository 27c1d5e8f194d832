#include "stability/wall/wall_theory.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr SampledDevice handle{.mass_kg = 0.1, .viscous_n_s_per_m = 0.4};

TEST(WallTheory, ColgateAndSchenkelFollowFromTheirTheoremOfAnyLinearWall) {
  for (const double damping : {0.0, 0.05, 0.1, 0.2, 0.39}) {
    EXPECT_NEAR(passive_stiffness(handle, damping), colgate_schenkel(handle, damping), 1e-6 + 800 * 1e-6)
        << damping;
  }
  EXPECT_EQ(passive_stiffness(handle, 0.41), 0.0);
  EXPECT_DOUBLE_EQ(colgate_schenkel(handle, 0.0), 800.0) << "K = 2 b / T";
}

TEST(WallTheory, ADelayOfOnePeriodCostsTwoThirdsOfThePassiveStiffness) {
  SampledDevice late = handle;
  late.delay_s = 1e-3;
  // b > K T / 2 + K T_d as w goes to 0.
  EXPECT_NEAR(passive_stiffness(late, 0.0), 0.4 / (0.5e-3 + 1e-3), 1e-3);
}

TEST(WallTheory, AbbottAndOkamuraTakeTheLesserOfFrictionAndEncoder) {
  SampledDevice device{.mass_kg = 0.1, .viscous_n_s_per_m = 0.5, .coulomb_n = 0.02, .encoder_step_m = 1e-4};
  EXPECT_DOUBLE_EQ(abbott_okamura(device), 400.0) << "2 f_c / delta";
  device.coulomb_n = 0.2;
  EXPECT_DOUBLE_EQ(abbott_okamura(device), 1000.0) << "2 b / T";
}

TEST(WallTheory, TheEigenvaluesOfAMassOnASampledSpringAreThoseOfItsPolynomial) {
  // m x'' = -K x_n without friction: z^2 - (2 - q) z + (1 + q), q = K T^2 / 2 m, of modulus sqrt(1 + q).
  const SampledDevice free{.mass_kg = 0.1, .viscous_n_s_per_m = 0.0};
  const double q = 500.0 * 1e-6 / 0.2;
  EXPECT_NEAR(spectral_radius(free, {.stiffness_n_per_m = 500.0}), std::sqrt(1.0 + q), 1e-10);
}

TEST(WallTheory, ASoftSampledSpringIsStableUpToTwiceTheDampingOverThePeriod) {
  // For a mass whose friction is small over a period (b T << m) the boundary is that of passivity.
  const SampledDevice heavy{.mass_kg = 100.0, .viscous_n_s_per_m = 0.4};
  EXPECT_NEAR(eigenvalue_boundary(heavy, 0.0, 10.0, 1e5), 800.0, 0.1);
}

TEST(WallTheory, StabilityReachesFurtherThanPassivity) {
  for (const double damping : {0.0, 0.1, 0.3}) {
    EXPECT_GT(eigenvalue_boundary(handle, damping, 10.0, 1e6), passive_stiffness(handle, damping));
  }
}

TEST(WallTheory, DelayAndAFilteredVelocityLowerTheStableStiffnessOfADampedWall) {
  const double undisturbed = eigenvalue_boundary(handle, 5.0, 1.0, 1e6);
  SampledDevice late = handle;
  late.delay_s = 2.5e-3;
  EXPECT_LT(eigenvalue_boundary(late, 5.0, 1.0, 1e6), undisturbed);
  SampledDevice filtered = handle;
  filtered.velocity_corner_rad_s = 60.0;
  EXPECT_LT(eigenvalue_boundary(filtered, 5.0, 1.0, 1e6), undisturbed);
}

}  // namespace
}  // namespace kerf::bench
