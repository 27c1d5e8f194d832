#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/kelvin.h>
#include <kerf/models/law.h>

namespace kerf::models {
namespace {

// Liver of [FuzzyKelvin], and the check values that follow from its equation in closed form.
constexpr Kelvin<double> liver{.parallel_stiffness = 8.0, .series_stiffness = 7.0, .damping = 130.0};

double ramp_and_hold(double time_s) { return std::min(2e-3 * time_s, 5e-3); }

double force_at(const Kelvin<double>& law, const std::function<double(double)>& path, double end_s,
                double period_s) {
  Kelvin<double>::State state;
  double force = law.step(state, {.penetration = path(0.0)}, period_s);
  const auto ticks = std::lround(end_s / period_s);
  for (long tick = 1; tick <= ticks; ++tick) {
    force = law.step(state, {.penetration = path(static_cast<double>(tick) * period_s)}, period_s);
  }
  return force;
}

TEST(Kelvin, MeetsTheCheckValuesOfRampAndHold) {
  EXPECT_NEAR(force_at(liver, ramp_and_hold, 2.5, 1e-3) / 0.0727464745656, 1.0, 1e-10);
  EXPECT_NEAR(force_at(liver, ramp_and_hold, 5.0, 1e-3) / 0.0686221222714, 1.0, 1e-10);
  EXPECT_NEAR(force_at(liver, ramp_and_hold, 30.0, 1e-3) / 0.0474485998763, 1.0, 1e-10);
}

TEST(Kelvin, MeetsTheCheckValuesAtTwoHertz) {
  const auto stiffness = liver.dynamic_stiffness(2.0 * std::numbers::pi * 2.0);
  EXPECT_NEAR(std::abs(stiffness) / 14.9999014656, 1.0, 1e-10);
  EXPECT_NEAR(std::arg(stiffness) / 0.00199961678241, 1.0, 1e-10);
}

TEST(Kelvin, StepsToTheDynamicStiffnessOfASine) {
  const double frequency = 2.0 * std::numbers::pi * 2.0;
  const Kelvin<double> quick{.parallel_stiffness = 8.0, .series_stiffness = 7.0, .damping = 0.4};
  const auto stiffness = quick.dynamic_stiffness(frequency);
  // After twenty relaxation times what is left of the start is under 1e-8 of the force.
  const auto path = [&](double t) { return 5e-3 + 1e-3 * std::sin(frequency * t); };
  const double expected =
      8.0 * 5e-3 + 1e-3 * std::abs(stiffness) * std::sin(frequency * 2.0 + std::arg(stiffness));
  EXPECT_NEAR(force_at(quick, path, 2.0, 1e-4), expected, 1e-8);
}

TEST(Kelvin, DoesNotDependOnThePeriod) {
  const auto zigzag = [](double t) { return 1e-3 * std::abs(std::remainder(t, 2.0)); };
  for (const double end_s : {1.0, 3.0, 7.5}) {
    const double slow = force_at(liver, zigzag, end_s, 1e-2);
    EXPECT_NEAR(force_at(liver, zigzag, end_s, 1e-4) / slow, 1.0, 1e-9);
  }
}

TEST(Kelvin, RelaxesToTheParallelSpring) {
  EXPECT_NEAR(force_at(liver, ramp_and_hold, 1000.0, 1e-2), 8.0 * 5e-3, 1e-12);
}

TEST(Kelvin, StartsRelaxedWhereverTheToolIs) {
  Kelvin<double>::State state;
  EXPECT_DOUBLE_EQ(liver.step(state, {.penetration = 5e-3}, 1e-3), 8.0 * 5e-3);
}

TEST(Kelvin, NeverPullsOnRelease) {
  Kelvin<double>::State state;
  double smallest = 1.0;
  double last = 0.0;
  for (int tick = 0; tick <= 4000; ++tick) {
    const double x = tick < 2000 ? ramp_and_hold(tick * 1e-3) : 0.0;
    last = liver.step(state, {.penetration = x}, 1e-3);
    smallest = std::min(smallest, last);
  }
  EXPECT_EQ(smallest, 0.0);
  EXPECT_EQ(last, 0.0);
  EXPECT_LT(state.arm_force, 0.0) << "the arm relaxes although nothing is felt";
}

TEST(Kelvin, TakesMoreEnergyThanItGivesOnClosedPathsAtEveryPeriod) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> depth(0.0, 8e-3);
  for (const double period_s : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    for (int path = 0; path < 20; ++path) {
      Kelvin<double>::State state;
      double last = 0.0;
      (void)liver.step(state, {.penetration = last}, period_s);
      double energy = 0.0;
      for (int tick = 0; tick < 200; ++tick) {
        const double x = tick == 199 ? 0.0 : depth(random);
        energy += liver.step(state, {.penetration = x}, period_s) * (x - last);
        last = x;
      }
      EXPECT_GE(energy, 0.0) << "at a period of " << period_s << " s";
    }
  }
}

TEST(Kelvin, ForwardEulerDivergesPastTwiceTheRelaxationTime) {
  const Kelvin<double> fast{
      .parallel_stiffness = 8.0, .series_stiffness = 700.0, .damping = 0.3, .integrator = Integrator::euler};
  ASSERT_GT(1e-3, 2.0 * fast.relaxation_time());
  // The sign alternates from tick to tick, and a negative force is not felt.
  EXPECT_GT(std::max(force_at(fast, ramp_and_hold, 0.2, 1e-3), force_at(fast, ramp_and_hold, 0.201, 1e-3)),
            1.0);
  EXPECT_NEAR(force_at(fast, ramp_and_hold, 3.0, 1e-5), 8.0 * 5e-3, 1e-6);
}

TEST(Kelvin, SemiImplicitStaysStableAtAnyPeriodAndIsOfFirstOrder) {
  const Kelvin<double> fast{.parallel_stiffness = 8.0,
                            .series_stiffness = 700.0,
                            .damping = 0.3,
                            .integrator = Integrator::semi_implicit};
  for (const double period_s : {1e-3, 1e-2, 0.5}) {
    EXPECT_NEAR(force_at(fast, ramp_and_hold, 3.0, period_s), 8.0 * 5e-3, 1e-3) << period_s;
  }
  const auto error_of = [&](double period_s) {
    const Kelvin<double> law{.parallel_stiffness = 8.0,
                             .series_stiffness = 7.0,
                             .damping = 1.4,
                             .integrator = Integrator::semi_implicit};
    Kelvin<double> exact = law;
    exact.integrator = Integrator::exact;
    return std::abs(force_at(law, ramp_and_hold, 2.6, period_s) -
                    force_at(exact, ramp_and_hold, 2.6, period_s));
  };
  EXPECT_NEAR(error_of(2e-3) / error_of(1e-3), 2.0, 0.02);
}

TEST(Kelvin, InSinglePrecisionKeepsItsForceToSevenDigitsAndItsRelaxationTime) {
  const Law law = Law::make("kelvin", std::vector{8.0, 7.0, 130.0});
  const Law single = Law::make("kelvin", law.values(), {{"precision", std::string("float")}});
  Law::State state = law.initial_state();
  Law::State single_state = single.initial_state();
  double worst = 0.0;
  for (int tick = 0; tick <= 30000; ++tick) {
    const Motion motion{.penetration = ramp_and_hold(tick * 1e-3), .velocity = 0.0};
    const double force = law.step(state, motion, 1e-3).force;
    worst = std::max(worst, std::abs(single.step(single_state, motion, 1e-3).force - force));
  }
  EXPECT_GT(worst, 0.0) << "it is single precision";
  EXPECT_LT(worst, 2e-5 * 0.0728) << "of the largest force, after 30,000 ticks of rounding";
}

TEST(Kelvin, RefusesAnUnknownIntegrator) {
  const std::vector<double> values{8.0, 7.0, 130.0};
  EXPECT_THROW(Kelvin<double>::make(values, {{"integrator", std::string("magic")}}), std::invalid_argument);
  EXPECT_EQ(Kelvin<double>::make(values, {{"integrator", std::string("euler")}}).integrator,
            Integrator::euler);
}

}  // namespace
}  // namespace kerf::models
