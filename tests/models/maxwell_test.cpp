#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/kelvin.h>
#include <kerf/models/maxwell.h>

namespace kerf::models {
namespace {

Maxwell<double> maxwell(const std::vector<double>& values, double arms) {
  return Maxwell<double>::make(values, {{"arms", arms}});
}

const Maxwell<double> tissue = maxwell({8.0, 7.0, 30.0, 11.0, 18.0, 0.4, 0.02}, 3.0);

double force_at(const Maxwell<double>& law, const std::function<double(double)>& path, double end_s,
                double period_s) {
  Maxwell<double>::State state;
  double force = law.step(state, {.penetration = path(0.0)}, period_s);
  const auto ticks = std::lround(end_s / period_s);
  for (long tick = 1; tick <= ticks; ++tick) {
    force = law.step(state, {.penetration = path(static_cast<double>(tick) * period_s)}, period_s);
  }
  return force;
}

constexpr double speed = 2e-3;
constexpr double ramp_s = 2.5;
double ramp_and_hold(double time_s) { return speed * std::min(time_s, ramp_s); }

double closed_form(const Maxwell<double>& law, double time_s) {
  double force = law.parallel_stiffness * ramp_and_hold(time_s);
  for (std::size_t i = 0; i < law.arms; ++i) {
    const double tau = law.relaxation_time[i];
    const double ramp = std::min(time_s, ramp_s);
    force += law.stiffness[i] * tau * speed * (1.0 - std::exp(-ramp / tau)) * std::exp((ramp - time_s) / tau);
  }
  return force;
}

TEST(Maxwell, MeetsTheClosedFormOfRampAndHold) {
  for (const double period_s : {1e-3, 0.1}) {
    for (const double time_s : {0.1, 1.0, 2.5, 2.6, 5.0, 30.0}) {
      EXPECT_NEAR(force_at(tissue, ramp_and_hold, time_s, period_s) / closed_form(tissue, time_s), 1.0, 1e-11)
          << time_s << " s at a period of " << period_s << " s";
    }
  }
}

TEST(Maxwell, WithOneArmIsKelvin) {
  const Kelvin<double> liver{.parallel_stiffness = 8.0, .series_stiffness = 7.0, .damping = 130.0};
  const auto law = maxwell({8.0, 7.0, 130.0 / 7.0}, 1.0);
  Kelvin<double>::State kelvin_state;
  Maxwell<double>::State state;
  for (int tick = 0; tick < 5000; ++tick) {
    const Motion motion{.penetration = 5e-3 * std::sin(2e-3 * tick), .velocity = 0.0};
    const double expected = liver.step(kelvin_state, motion, 1e-3);
    ASSERT_NEAR(law.step(state, motion, 1e-3), expected, 1e-12) << tick;
  }
  EXPECT_NEAR(std::abs(law.dynamic_stiffness(12.0) - liver.dynamic_stiffness(12.0)), 0.0, 1e-13);
  EXPECT_NEAR(law.stored_energy(state) / liver.stored_energy(kelvin_state), 1.0, 1e-9);
}

TEST(Maxwell, MeetsTheCheckValuesOfLiver) {
  const auto law = maxwell({8.0, 7.0, 130.0 / 7.0}, 1.0);
  EXPECT_NEAR(force_at(law, ramp_and_hold, 2.5, 1e-3) / 0.0727464745656, 1.0, 1e-10) << "by the closed form";
  EXPECT_NEAR(force_at(law, ramp_and_hold, 30.0, 1e-3) / 0.0474485998763, 1.0, 1e-10);
}

TEST(Maxwell, DoesNotCareForTheOrderOfItsArms) {
  const auto turned = maxwell({8.0, 11.0, 30.0, 7.0, 0.02, 0.4, 18.0}, 3.0);
  EXPECT_NEAR(force_at(turned, ramp_and_hold, 4.0, 1e-3) / force_at(tissue, ramp_and_hold, 4.0, 1e-3), 1.0,
              1e-13);
}

TEST(Maxwell, TwoArmsOfOneTimeAreOneOfTheirSum) {
  const auto two = maxwell({8.0, 3.0, 4.0, 0.4, 0.4}, 2.0);
  const auto one = maxwell({8.0, 7.0, 0.4}, 1.0);
  EXPECT_NEAR(force_at(two, ramp_and_hold, 3.0, 1e-3) / force_at(one, ramp_and_hold, 3.0, 1e-3), 1.0, 1e-13);
}

TEST(Maxwell, StepsToTheDynamicStiffnessOfASine) {
  const double frequency = 2.0 * std::numbers::pi * 2.0;
  const auto quick = maxwell({8.0, 7.0, 20.0, 0.06, 0.005}, 2.0);
  const auto stiffness = quick.dynamic_stiffness(frequency);
  const auto path = [&](double t) { return 5e-3 + 1e-3 * std::sin(frequency * t); };
  const double expected =
      8.0 * 5e-3 + 1e-3 * std::abs(stiffness) * std::sin(frequency * 2.1 + std::arg(stiffness));
  EXPECT_NEAR(force_at(quick, path, 2.1, 1e-5), expected, 1e-9);
}

TEST(Maxwell, HasTheSameForceWhateverThePeriods) {
  Maxwell<double>::State state;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> part(1e-4, 0.05);
  double now_s = 0.0;
  double force = tissue.step(state, {}, 1e-3);
  while (now_s < ramp_s) {
    const double period_s = std::min(part(random), ramp_s - now_s);
    now_s += period_s;
    force = tissue.step(state, {.penetration = speed * now_s}, period_s);
  }
  EXPECT_NEAR(force / closed_form(tissue, ramp_s), 1.0, 1e-12);
}

TEST(Maxwell, StaysFiniteAndTendsToItsSpringsAtBothEndsOfItsTimes) {
  const auto slow = maxwell({8.0, 7.0, 1e6}, 1.0);
  EXPECT_NEAR(force_at(slow, ramp_and_hold, 2.5, 1e-3) / (15.0 * 5e-3), 1.0, 2e-6);
  const auto fast = maxwell({8.0, 7.0, 1e-6}, 1.0);
  EXPECT_NEAR(force_at(fast, ramp_and_hold, 2.5, 1e-3), 8.0 * 5e-3 + 7.0 * 1e-6 * speed, 1e-15);
}

TEST(Maxwell, NeverPullsOnReleaseWhileItsArmsRelax) {
  Maxwell<double>::State state;
  double smallest = 1.0;
  for (int tick = 0; tick <= 4000; ++tick) {
    const double x = tick < 2000 ? ramp_and_hold(tick * 1e-3) : 0.0;
    smallest = std::min(smallest, tissue.step(state, {.penetration = x}, 1e-3));
  }
  EXPECT_EQ(smallest, 0.0);
  EXPECT_LT(state.arm_force[0], 0.0);
}

TEST(Maxwell, ForgetsALongRestWithoutDenormalNumbers) {
  Maxwell<double>::State state;
  (void)tissue.step(state, {}, 1e-3);
  for (int tick = 0; tick < 20000; ++tick) (void)tissue.step(state, {.penetration = 1e-3}, 1e-3);
  EXPECT_EQ(state.arm_force[2], 0.0) << "after a thousand of its relaxation times";
  EXPECT_GT(state.arm_force[0], 0.0);
}

TEST(Maxwell, TakesInWhatItStoresAndMore) {
  // The work of a tick from the force at its end is at least that of the path: the arms have given way.
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> displacement(-8e-3, 8e-3);
  for (const double period_s : {1e-4, 1e-2, 1.0}) {
    Maxwell<double>::State state;
    double last = 0.0;
    (void)tissue.bilateral_step(state, last, period_s);
    double work = 0.0;
    for (int tick = 0; tick < 500; ++tick) {
      const double x = displacement(random);
      // Twenty pieces, so that the trapezoid is the integral.
      for (int piece = 1; piece <= 20; ++piece) {
        const double before = state.penetration;
        const double next = last + (x - last) * piece / 20.0;
        const double held =
            tissue.parallel_stiffness * before + state.arm_force[0] + state.arm_force[1] + state.arm_force[2];
        const double force = tissue.bilateral_step(state, next, period_s / 20.0);
        work += 0.5 * (held + force) * (next - before);
      }
      last = x;
      ASSERT_GE(work, tissue.stored_energy(state) * (1.0 - 1e-3)) << "at a period of " << period_s << " s";
    }
  }
}

TEST(Maxwell, RefusesMoreArmsThanSixAndNone) {
  const std::vector<double> values(20, 1.0);
  for (const double arms : {0.0, 7.0, 1.5}) {
    EXPECT_THROW((void)maxwell(values, arms), std::invalid_argument) << arms;
  }
  EXPECT_EQ(Maxwell<double>::parameters({{"arms", 6.0}}).size(), 13u);
  EXPECT_EQ(Maxwell<double>::parameters({}).size(), 5u);
}

}  // namespace
}  // namespace kerf::models
