#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/hunt_crossley.h>

namespace kerf::models {
namespace {

HuntCrossley<double> contact(double damping, double exponent = 1.5) {
  return {.reference_force = 0.5, .reference_damping = damping, .exponent = exponent};
}
double force(const HuntCrossley<double>& law, double x, double velocity = 0.0) {
  HuntCrossley<double>::State none;
  return law.step(none, {.penetration = x, .velocity = velocity}, 1e-3);
}

TEST(HuntCrossley, IsGivenAtItsReferenceDepth) {
  EXPECT_DOUBLE_EQ(force(contact(0.2), 0.01), 0.5);
  EXPECT_DOUBLE_EQ(force(contact(0.2), 0.01, 0.3), 0.5 + 0.2 * 0.3);
}

TEST(HuntCrossley, IsThePowerLawOfItsUsualForm) {
  const double k = 0.5 / std::pow(0.01, 1.5);
  const double b = 0.2 / std::pow(0.01, 1.5);
  for (const double x : {1e-4, 3e-3, 0.05}) {
    EXPECT_NEAR(force(contact(0.2), x, 0.1) / (std::pow(x, 1.5) * (k + b * 0.1)), 1.0, 1e-13);
  }
}

TEST(HuntCrossley, BeginsAndEndsWithoutAJumpAndNeverPulls) {
  const auto law = contact(0.2);
  EXPECT_EQ(force(law, 0.0, 1.0), 0.0);
  EXPECT_EQ(force(law, -0.1, 1.0), 0.0);
  EXPECT_LT(force(law, 1e-9, 10.0), 1e-9) << "a Kelvin-Voigt contact would jump by its damping";
  EXPECT_EQ(force(law, 0.01, -2.5), 0.0) << "where F1 + B1 v vanishes";
  EXPECT_EQ(force(law, 0.01, -10.0), 0.0);
}

TEST(HuntCrossley, MayResistLessWhenMetFaster) {
  EXPECT_LT(force(contact(-0.2), 0.01, 0.5), force(contact(-0.2), 0.01));
  EXPECT_EQ(force(contact(-0.2), 0.01, 10.0), 0.0);
}

TEST(HuntCrossley, StoresTheIntegralOfItsForce) {
  for (const double exponent : {0.7, 1.0, 2.5}) {
    const auto law = contact(0.0, exponent);
    double energy = 0.0;
    constexpr int pieces = 20000;
    for (int i = 0; i < pieces; ++i) energy += force(law, 0.02 * (i + 0.5) / pieces) * 0.02 / pieces;
    EXPECT_NEAR(law.stored_energy(0.02) / energy, 1.0, 1e-5);
    EXPECT_EQ(law.stored_energy(-0.02), 0.0);
  }
}

/// Speed at which a mass of 50 g leaves that arrived at 0.2 m/s: the midpoint rule of second order, the last
/// step cut off at the surface.
double rebound_speed(const HuntCrossley<double>& law) {
  const double mass = 0.05;
  const double step_s = 1e-6;
  double x = 0.0;
  double v = 0.2;
  for (int i = 0; i < 10000000; ++i) {
    const double middle_x = x + 0.5 * step_s * v;
    const double middle_v = v - 0.5 * step_s * force(law, x, v) / mass;
    x += step_s * middle_v;
    v -= step_s * force(law, middle_x, middle_v) / mass;
    if (x <= 0.0) return -v;
  }
  return 0.0;
}

TEST(HuntCrossley, LosesInABounceWhatTheClosedFormSays) {
  for (const double exponent : {1.0, 1.5, 3.0}) {
    for (const double damping : {0.05, 0.5, 2.0}) {
      const double q = damping / 0.5;
      const double left = rebound_speed(contact(damping, exponent));
      EXPECT_NEAR(-q * left - std::log1p(-q * left), q * 0.2 - std::log1p(q * 0.2), 1e-7)
          << "n = " << exponent << ", B1 = " << damping;
    }
  }
}

TEST(HuntCrossley, LosesTwoThirdsOfTheRatioTimesTheSpeedToFirstOrder) {
  const double damping = 0.01;
  EXPECT_NEAR((1.0 - rebound_speed(contact(damping)) / 0.2) / (2.0 / 3.0 * damping / 0.5 * 0.2), 1.0, 5e-3);
  EXPECT_NEAR(rebound_speed(contact(0.0)), 0.2, 1e-7) << "without damping nothing is lost";
}

}  // namespace
}  // namespace kerf::models
