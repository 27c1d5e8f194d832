#include "kerf/drivers/simulated_axis.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

constexpr double dt = 50e-6;
const SimulatedAxis frictionless{.mass_kg = 0.2, .viscous_n_s_per_m = 0.0, .coulomb_n = 0.0};

SimulatedAxis::State after(double seconds, const SimulatedAxis& axis, SimulatedAxis::State state,
                           const SimulatedAxis::Drive& drive = {}) {
  const auto steps = std::lround(seconds / dt);
  for (long i = 0; i < steps; ++i) axis.step(state, drive, dt);
  return state;
}

TEST(SimulatedAxis, FallsFreelyUnderAConstantForce) {
  const auto state = after(0.1, frictionless, {}, {.force_n = 2.0});
  EXPECT_NEAR(state.speed_m_s, 2.0 / 0.2 * 0.1, 1e-12);
  EXPECT_NEAR(state.travel_m, 0.5 * 10.0 * 0.01, 10.0 * 0.1 * dt) << "first order in the step";
}

TEST(SimulatedAxis, LosesSpeedToViscousFrictionAsAnExponential) {
  SimulatedAxis axis = frictionless;
  axis.viscous_n_s_per_m = 0.4;
  EXPECT_NEAR(after(0.5, axis, {.speed_m_s = 1.0}).speed_m_s, std::exp(-0.4 / 0.2 * 0.5), 1e-4);
}

TEST(SimulatedAxis, StopsByCoulombFrictionAfterTheWorkOfItsEnergy) {
  SimulatedAxis axis = frictionless;
  axis.coulomb_n = 0.5;
  const auto state = after(1.0, axis, {.speed_m_s = 0.5});
  EXPECT_EQ(state.speed_m_s, 0.0);
  EXPECT_NEAR(state.travel_m, 0.5 * 0.2 * 0.25 / 0.5, 1e-4) << "m v^2 / 2 = f_c s";
}

TEST(SimulatedAxis, SticksUnderAForceSmallerThanCoulombFriction) {
  SimulatedAxis axis = frictionless;
  axis.coulomb_n = 0.5;
  EXPECT_EQ(after(1.0, axis, {}, {.force_n = 0.499}).travel_m, 0.0);
  EXPECT_GT(after(1.0, axis, {}, {.force_n = 0.501}).travel_m, 0.0);
}

TEST(SimulatedAxis, GivesWayByTheForceOverTheStiffnessOfTheHand) {
  SimulatedAxis axis = frictionless;
  axis.hand_stiffness_n_per_m = 500.0;
  axis.hand_damping_n_s_per_m = 5.0;
  EXPECT_NEAR(after(5.0, axis, {}, {.equilibrium_m = 0.01, .force_n = 2.0}).travel_m, 0.01 + 2.0 / 500.0,
              1e-12);
}

TEST(SimulatedAxis, NeverGainsEnergyByItself) {
  SimulatedAxis axis = frictionless;
  axis.hand_stiffness_n_per_m = 600.0;
  SimulatedAxis::State state{.travel_m = 0.05, .speed_m_s = 0.3};
  const auto energy = [&] {
    return 0.5 * axis.mass_kg * state.speed_m_s * state.speed_m_s +
           0.5 * axis.hand_stiffness_n_per_m * state.travel_m * state.travel_m;
  };
  double last = energy();
  for (int i = 0; i < 100'000; ++i) {
    axis.step(state, {}, dt);
    ASSERT_LE(energy(), last * (1.0 + 1e-12)) << "in step " << i;
    last = energy();
  }
}

TEST(SimulatedAxis, SpeedsUpByTheFrequencyOfHandAndMass) {
  SimulatedAxis axis = frictionless;
  axis.hand_stiffness_n_per_m = 500.0;
  const double quarter_period_s = 0.5 * std::acos(-1.0) * std::sqrt(0.2 / 500.0);
  const auto state = after(quarter_period_s, axis, {.travel_m = 0.01});
  EXPECT_NEAR(state.travel_m, 0.0, 1e-4);
  EXPECT_NEAR(state.speed_m_s, -0.01 * std::sqrt(500.0 / 0.2), 5e-3);
}

TEST(SimulatedAxis, StaysWithinItsStops) {
  SimulatedAxis axis = frictionless;
  axis.upper_m = 0.02;
  const auto state = after(1.0, axis, {}, {.force_n = 5.0});
  EXPECT_EQ(state.travel_m, 0.02);
  EXPECT_EQ(state.speed_m_s, 0.0);
}

}  // namespace
}  // namespace kerf::drivers
