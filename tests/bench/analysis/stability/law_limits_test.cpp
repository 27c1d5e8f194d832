#include "stability/law_limits.h"

#include <cmath>

#include <gtest/gtest.h>

#include <kerf/models/exponential.h>

#include "stability/maps.h"
#include "stability/strokes.h"

namespace kerf::bench {
namespace {

constexpr SampledDevice handle{.mass_kg = 0.1, .viscous_n_s_per_m = 0.4};

/// Spring and damper that pull as they push.
struct Element {
  double stiffness = 0.0;
  double damping = 0.0;
  double operator()(const AxisReading& at) const noexcept {
    return -stiffness * at.position_m - damping * at.speed_m_s;
  }
};

TEST(Strokes, AHeldSpringGivesKvTdOfEnergyPerPass) {
  const SampledDevice frictionless{.mass_kg = 0.1, .viscous_n_s_per_m = 0.0};
  const Stroke pass{.from_m = 0.0, .to_m = 0.01, .ticks = 50};
  const double speed = pass.speed_m_s(1e-3);
  EXPECT_NEAR(energy_gained(frictionless, Element{.stiffness = 300.0}, pass), 300.0 * speed * 1e-3 * 0.01,
              1e-15);
}

TEST(Strokes, ASpringIsPassiveUpToTwiceTheFrictionOverThePeriod) {
  const Stroke pass{.from_m = 0.0, .to_m = 0.01, .ticks = 50};
  EXPECT_LT(energy_gained(handle, Element{.stiffness = 799.0}, pass), 0.0);
  EXPECT_GT(energy_gained(handle, Element{.stiffness = 801.0}, pass), 0.0);
}

TEST(Strokes, OfOneTickFindADamperThatIsGreaterThanTheFriction) {
  const Stroke shake{.from_m = 0.0, .to_m = 0.001, .ticks = 1};
  EXPECT_LT(energy_gained(handle, Element{.damping = 0.399}, shake), 0.0);
  EXPECT_GT(energy_gained(handle, Element{.damping = 0.401}, shake), 0.0);
  const Stroke slow{.from_m = 0.0, .to_m = 0.01, .ticks = 50};
  EXPECT_LT(energy_gained(handle, Element{.damping = 5.0}, slow), 0.0) << "which a slow stroke does not see";
}

TEST(Strokes, FollowColgateAndSchenkelInBothTogether) {
  const Stroke shake{.from_m = 0.0, .to_m = 0.001, .ticks = 1};
  const double stiffness = 2.0 * (0.4 - 0.1) / 1e-3;
  EXPECT_LT(energy_gained(handle, Element{stiffness - 1.0, 0.1}, shake), 0.0);
  EXPECT_GT(energy_gained(handle, Element{stiffness + 1.0, 0.1}, shake), 0.0);
}

TEST(Strokes, FollowAbbottAndOkamuraWithAnEncoder) {
  SampledDevice coarse = handle;
  coarse.encoder_step_m = 1e-4;
  coarse.coulomb_n = 0.03;
  const Stroke creep{.from_m = 0.0, .to_m = 0.001, .ticks = 100000};
  EXPECT_LT(energy_gained(coarse, Element{.stiffness = 599.0}, creep), 0.0) << "2 f_c / delta = 600";
  EXPECT_GT(energy_gained(coarse, Element{.stiffness = 602.0}, creep), 0.0);
}

AxisLaw intestine() {
  const double values[] = {4.3e-7, 13.0};
  return {models::Law::make("exponential", values, {{"viscous", false}})};
}

TEST(LawLimits, TheExponentialFailsWhereItsLocalStiffnessIsTwiceTheFrictionOverThePeriod) {
  const models::Exponential<double> law{.amplitude = 4.3e-7, .exponent = 13.0, .thickness = 0.1};
  const LawLimits limits = limits_of(handle, intestine(), {.depth_m = 0.12, .speed_m_s = 0.5}, 0.2);
  ASSERT_TRUE(limits.depth_m.at);
  EXPECT_NEAR(*limits.depth_m.at, law.depth_at_stiffness(800.0), 0.006 * *limits.depth_m.at);
  EXPECT_NEAR(*limits.local_depth_m.at, law.depth_at_stiffness(800.0), 0.006 * *limits.depth_m.at);
  EXPECT_NEAR(limits.local.stiffness_n_per_m, 800.0, 60.0);
}

TEST(LawLimits, TheLowestRateOfASpringIsItsStiffnessOverTwiceTheFriction) {
  const double values[] = {1e-9 + 400.0, 1e-9, 1e-9};
  const AxisLaw spring{models::Law::make("kelvin", values)};
  const LawLimits limits = limits_of(handle, spring, {.depth_m = 0.01, .speed_m_s = 0.5}, 0.1);
  ASSERT_TRUE(limits.rate_hz.at);
  EXPECT_NEAR(*limits.rate_hz.at, 400.0 / (2.0 * 0.4), 0.01 * 500.0);
  EXPECT_FALSE(limits.depth_m.at) << "at 1 kHz it holds however deep";
}

TEST(LawLimits, ADelayCountsAsTwiceItsTimeOfThePeriod) {
  SampledDevice late = handle;
  late.delay_s = 0.4e-3;  // forty periods of the highest rate that is tried
  const double values[] = {1e-9 + 400.0, 1e-9, 1e-9};
  const AxisLaw spring{models::Law::make("kelvin", values)};
  const LawLimits limits = limits_of(late, spring, {.depth_m = 0.01, .speed_m_s = 0.5}, 0.1);
  ASSERT_TRUE(limits.rate_hz.at);
  EXPECT_NEAR(*limits.rate_hz.at, 1.0 / (2.0 * (0.4 / 400.0 - late.delay_s)), 0.01 * 833.0)
      << "b = K (T / 2 + delay)";
}

TEST(LawLimits, CoulombFrictionHoldsAWallUpToASpeedInClosedForm) {
  SampledDevice dry = handle;
  dry.coulomb_n = 0.02;
  const double values[] = {1600.0, 1e-9, 1e-9};
  const AxisLaw stiff{models::Law::make("kelvin", values)};
  const LawLimits limits = limits_of(dry, stiff, {.depth_m = 0.01, .speed_m_s = 0.5}, 0.1);
  ASSERT_TRUE(limits.speed_m_s.at);
  EXPECT_NEAR(*limits.speed_m_s.at, 0.02 / (0.5 * 1600.0 * 1e-3 - 0.4), 0.01 * 0.05) << "f_c / (K T / 2 - b)";
}

TEST(LawLimits, ADamperIsPassiveUpToTheDevicesFriction) {
  // F = alpha exp(...) + B0 v with next to no elastic part.
  for (const double damping : {0.3, 0.5}) {
    const double values[] = {1e-12, 1e-6, damping};
    const AxisLaw law{models::Law::make("exponential", values)};
    EXPECT_EQ(is_passive(handle, law, {.depth_m = 0.01, .speed_m_s = 1.0}), damping < 0.4);
    EXPECT_EQ(is_locally_passive(handle, law, {.depth_m = 0.01, .speed_m_s = 1.0}), damping < 0.4);
  }
}

TEST(LawLimits, AKelvinTissueIsPassiveAtAnyRate) {
  // Liver [FuzzyKelvin]: far softer than the friction of any handle.
  const double values[] = {8.0, 7.0, 130.0};
  const LawLimits limits =
      limits_of(handle, {models::Law::make("kelvin", values)}, {.depth_m = 0.02, .speed_m_s = 0.3}, 0.1);
  EXPECT_FALSE(limits.depth_m.at);
  EXPECT_FALSE(limits.rate_hz.at && *limits.rate_hz.at > 30.0);
}

TEST(LawLimits, ToldApartAreALawThatNeverFailsAndOneThatAlwaysDoes) {
  const double values[] = {1e-12, 1e-6, 0.5};  // a damper beyond the friction, at every depth
  const LawLimits never =
      limits_of(handle, {models::Law::make("exponential", values)}, {.depth_m = 0.01, .speed_m_s = 1.0}, 0.1);
  EXPECT_TRUE(never.local_depth_m.holds_nowhere);
  EXPECT_FALSE(never.local_depth_m.at);
  EXPECT_DOUBLE_EQ(never.local_depth_m.first, 1e-4);
  const double liver[] = {8.0, 7.0, 130.0};
  const LawLimits always =
      limits_of(handle, {models::Law::make("kelvin", liver)}, {.depth_m = 0.02, .speed_m_s = 0.3}, 0.1);
  EXPECT_FALSE(always.local_depth_m.holds_nowhere);
  EXPECT_FALSE(always.local_depth_m.at);
  EXPECT_DOUBLE_EQ(always.local_depth_m.last, 0.1);
}

TEST(LawLimits, ARelaxingLawIsLocallyAsStiffAsItsSpringsTogether) {
  const double values[] = {8.0, 7.0, 0.07};  // tau = 10 ms
  const Local local = local_impedance({models::Law::make("kelvin", values)}, 0.01, 1e-4);
  EXPECT_NEAR(local.stiffness_n_per_m, 8.0 + 7.0 * (1.0 - std::exp(-0.01)) / 0.01, 1e-6);
  EXPECT_NEAR(local.damping_n_s_per_m, 0.0, 1e-9);
}

TEST(LawMap, OfTheExponentialAgreesWithItsLocalStiffness) {
  const LawMap map = law_map(handle, intestine(), 0.5, {linear(0.05, 0.2, 24), logarithmic(100.0, 4000.0, 8)},
                             {.threads = 2});
  EXPECT_GT(map.agreement(), 0.98);
  EXPECT_TRUE(map.cells.front().stable);
  EXPECT_FALSE(map.cells[23].stable);
}

TEST(Press, OnATissueThatIsTooStiffForTheDeviceHums) {
  SampledDevice held = handle;
  held.coulomb_n = 0.0;
  held.hand = {.mass_kg = 0.15, .damping_n_s_per_m = 2.0, .stiffness_n_per_m = 300.0};
  const double soft[] = {500.0, 1e-9, 1e-9};
  const double stiff[] = {20000.0, 1e-9, 1e-9};
  EXPECT_TRUE(press(held, {models::Law::make("kelvin", soft)}, {.depth_m = 0.005}).stable);
  const PressVerdict limit_cycle = press(held, {models::Law::make("kelvin", stiff)}, {.depth_m = 0.0005});
  EXPECT_FALSE(limit_cycle.stable);
  EXPECT_GT(limit_cycle.ripple_n, 0.05);
}

TEST(Press, UnderThePassivityControllerStaysStillWhereItHummedAndASoftTissueIsNotTouched) {
  SampledDevice held = handle;
  held.coulomb_n = 0.0;
  held.hand = {.mass_kg = 0.15, .damping_n_s_per_m = 2.0, .stiffness_n_per_m = 300.0};
  const auto pressed = [&](double stiffness, bool controlled) {
    const double values[] = {stiffness, 1e-9, 1e-9};
    return press(held, {models::Law::make("kelvin", values)},
                 {.depth_m = 0.002, .passivity_control = controlled});
  };
  const PressVerdict soft = pressed(2.0 * 0.9 * held.viscous_n_s_per_m / held.period_s, true);
  EXPECT_EQ(soft.added_n, 0.0) << "below K = 2 b / T it never acts";
  double hums = 1000.0;
  while (pressed(hums, false).stable) hums *= 1.1;
  const PressVerdict controlled = pressed(hums, true);
  EXPECT_TRUE(controlled.stable) << hums;
  EXPECT_GT(controlled.added_n, 0.0);
  EXPECT_LT(controlled.ripple_n, pressed(hums, false).ripple_n);
}

TEST(WallMap, IsTheSameForAnyNumberOfThreads) {
  SampledDevice device = handle;
  device.coulomb_n = 0.05;
  device.encoder_step_m = 3e-5;
  const Grid2 grid{logarithmic(50.0, 5e4, 12), linear(0.0, 30.0, 6)};
  const WallMap one = wall_map(device, {.push_n = 2.0}, grid, {.threads = 1});
  const WallMap three = wall_map(device, {.push_n = 2.0}, grid, {.threads = 3});
  for (std::size_t i = 0; i < one.cells.size(); ++i) {
    EXPECT_EQ(one.cells[i].stable, three.cells[i].stable);
  }
  for (std::size_t i = 0; i < one.boundaries.size(); ++i) {
    EXPECT_EQ(one.boundaries[i].simulated, three.boundaries[i].simulated);
  }
}

TEST(WallMap, OfALinearWallAgreesWithItsEigenvaluesInEveryCellButAtTheEdge) {
  const Grid2 grid{logarithmic(50.0, 1e5, 30), linear(0.0, 40.0, 12)};
  EXPECT_GT(wall_map(handle, {}, grid, {.threads = 2}).agreement(), 0.99);
}

}  // namespace
}  // namespace kerf::bench
