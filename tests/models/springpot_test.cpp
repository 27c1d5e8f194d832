#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/springpot.h>

namespace kerf::models {
namespace {

constexpr double orders[] = {0.01, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99};
constexpr double c = 3.0;
constexpr double speed = 2e-3;

Springpot<double> springpot(double order, double reference_s = 1.0) {
  return Springpot<double>::make(std::vector{c, order}, {{"spring", false}, {"reference_time", reference_s}});
}

/// What a ramp from rest gives after a time, c v t^(1-alpha) / Gamma(2-alpha).
double ramp_force(double order, double time_s) {
  return time_s <= 0.0 ? 0.0 : c * speed * std::pow(time_s, 1.0 - order) / std::tgamma(2.0 - order);
}

TEST(Springpot, MeetsTheClosedFormOfARampFromTwentyMicrosecondsToAnHour) {
  for (const double order : orders) {
    const auto law = springpot(order);
    Springpot<double>::State state;
    double now_s = 0.0;
    double worst = 0.0;
    (void)law.step(state, {}, 1e-3);
    for (double next_s = 2e-5; next_s < 3600.0; next_s *= 1.2) {
      const double force = law.step(state, {.penetration = speed * next_s}, next_s - now_s);
      now_s = next_s;
      worst = std::max(worst, std::abs(force / ramp_force(order, now_s) - 1.0));
    }
    EXPECT_LT(worst, 3e-5) << "order " << order;
  }
}

TEST(Springpot, RelaxesAsTheClosedFormAfterARamp) {
  const double ramp_s = 0.01;
  for (const double order : orders) {
    const auto law = springpot(order);
    Springpot<double>::State state;
    (void)law.step(state, {}, 1e-3);
    double force = law.step(state, {.penetration = speed * ramp_s}, ramp_s);
    double worst = std::abs(force / ramp_force(order, ramp_s) - 1.0);
    double now_s = ramp_s;
    for (double held_s = 1e-3; held_s < 3600.0; held_s *= 1.2) {
      force = law.step(state, {.penetration = speed * ramp_s}, ramp_s + held_s - now_s);
      now_s = ramp_s + held_s;
      // The difference of two powers of nearly the same time; expm1 keeps its digits.
      const double expected = c * speed / std::tgamma(2.0 - order) * std::pow(held_s, 1.0 - order) *
                              std::expm1((1.0 - order) * std::log1p(ramp_s / held_s));
      worst = std::max(worst, std::abs(force / expected - 1.0));
    }
    EXPECT_LT(worst, 1e-4) << "order " << order;
  }
}

TEST(Springpot, AnswersASineAheadByAQuarterTurnTimesItsOrder) {
  const double frequency = 2.0 * std::numbers::pi * 2.0;
  const double amplitude = 1e-3;
  constexpr double period_s = 1e-4;
  constexpr int ticks_a_cycle = 5000;
  for (const double order : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const auto law = springpot(order);
    Springpot<double>::State state;
    std::complex<double> response = 0.0;
    constexpr int cycles = 10;
    for (int tick = 0; tick < cycles * ticks_a_cycle; ++tick) {
      const double time_s = period_s * tick;
      const double force = law.bilateral_step(state, amplitude * std::sin(frequency * time_s), period_s);
      if (tick < (cycles - 1) * ticks_a_cycle) continue;
      response += force * std::polar(2.0 / (amplitude * ticks_a_cycle), -frequency * time_s);
    }
    response *= std::complex<double>(0.0, 1.0);  // of a sine
    const double phase = 0.5 * std::numbers::pi * order;
    EXPECT_NEAR(std::abs(response) / (c * std::pow(frequency, order)), 1.0, 1e-4) << "order " << order;
    // A path that is linear between ticks trails the sine by up to half a tick.
    EXPECT_NEAR(std::arg(response), phase, 0.5 * frequency * period_s) << "order " << order;
    EXPECT_NEAR(
        std::abs(law.dynamic_stiffness(frequency) - std::polar(c * std::pow(frequency, order), phase)), 0.0,
        1e-12);
  }
}

TEST(Springpot, HasTheSameForceWhateverThePeriod) {
  const auto zigzag = [](double t) { return 1e-3 + 1e-3 * std::abs(std::remainder(t, 2.0)); };
  for (const double order : {0.1, 0.5, 0.9}) {
    const auto law = springpot(order);
    const auto force_at = [&](double end_s, double period_s) {
      Springpot<double>::State state;
      double force = law.step(state, {.penetration = zigzag(0.0)}, period_s);
      for (long tick = 1; tick <= std::lround(end_s / period_s); ++tick) {
        force = law.step(state, {.penetration = zigzag(static_cast<double>(tick) * period_s)}, period_s);
      }
      return force;
    };
    for (const double end_s : {1.0, 2.5, 7.5}) {
      const double slow = force_at(end_s, 0.1);
      EXPECT_NEAR(force_at(end_s, 1e-3), slow, 1e-11) << "order " << order;
      EXPECT_NEAR(force_at(end_s, 1e-4), slow, 1e-11) << "order " << order;
    }
  }
}

TEST(Springpot, LiesBetweenASpringAndADashpot) {
  const auto nearly_spring = springpot(0.01);
  const auto nearly_dashpot = springpot(0.99);
  Springpot<double>::State first;
  Springpot<double>::State second;
  (void)nearly_spring.step(first, {}, 1e-3);
  (void)nearly_dashpot.step(second, {}, 1e-3);
  EXPECT_NEAR(nearly_spring.step(first, {.penetration = speed}, 1.0) / (c * speed), 1.0, 0.01);
  EXPECT_NEAR(nearly_dashpot.step(second, {.penetration = speed}, 1.0) / (c * speed), 1.0, 0.01);
}

TEST(Springpot, ItsReferenceTimeOnlyScales) {
  const double order = 0.3;
  const auto at_one = springpot(order);
  const auto at_hundred = Springpot<double>::make(std::vector{c * std::pow(100.0, -order), order},
                                                  {{"spring", false}, {"reference_time", 100.0}});
  Springpot<double>::State first;
  Springpot<double>::State second;
  for (int tick = 0; tick < 1000; ++tick) {
    const Motion motion{.penetration = 1e-3 * std::abs(std::sin(0.01 * tick)), .velocity = 0.0};
    const double expected = at_one.step(first, motion, 1e-3);
    ASSERT_NEAR(at_hundred.step(second, motion, 1e-3), expected, 1e-15 + 1e-13 * expected);
  }
}

TEST(Springpot, AddsItsSpring) {
  const auto with = Springpot<double>::make(std::vector{8.0, c, 0.4}, {});
  const auto without = springpot(0.4);
  Springpot<double>::State first;
  Springpot<double>::State second;
  EXPECT_EQ(with.step(first, {.penetration = 2e-3}, 1e-3), 8.0 * 2e-3) << "the first tick finds it relaxed";
  EXPECT_EQ(without.step(second, {.penetration = 2e-3}, 1e-3), 0.0);
  EXPECT_NEAR(with.step(first, {.penetration = 5e-3}, 1e-3),
              8.0 * 5e-3 + without.step(second, {.penetration = 5e-3}, 1e-3), 1e-15);
}

TEST(Springpot, NeverPullsOnReleaseWhileItRelaxes) {
  const auto law = springpot(0.4);
  Springpot<double>::State state;
  double smallest = 1.0;
  double felt = 0.0;
  for (int tick = 0; tick <= 4000; ++tick) {
    const double x = tick < 2000 ? speed * 1e-3 * tick : 0.0;
    felt = law.step(state, {.penetration = x}, 1e-3);
    smallest = std::min(smallest, felt);
  }
  EXPECT_EQ(smallest, 0.0);
  EXPECT_EQ(felt, 0.0);
}

TEST(Springpot, TakesInOverACycleWhatItsPhaseSays) {
  const double order = 0.5;
  const double frequency = 2.0 * std::numbers::pi * 2.0;
  const double amplitude = 1e-3;
  const auto law = springpot(order);
  Springpot<double>::State state;
  double energy = 0.0;
  double before = 0.0;
  double last = 0.0;
  for (int tick = 0; tick <= 100 * 500; ++tick) {
    const double x = amplitude * std::sin(frequency * 1e-3 * tick);
    const double force = law.bilateral_step(state, x, 1e-3);
    if (tick > 99 * 500) energy += 0.5 * (before + force) * (x - last);
    before = force;
    last = x;
  }
  const double expected = std::numbers::pi * amplitude * amplitude * c * std::pow(frequency, order) *
                          std::sin(0.5 * std::numbers::pi * order);
  EXPECT_NEAR(energy / expected, 1.0, 1e-3);
}

TEST(Springpot, HoldsLessThanWasPutIn) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> step(0.0, 1e-4);
  for (const double order : {0.1, 0.5, 0.9}) {
    const auto law = springpot(order);
    Springpot<double>::State state;
    double x = 0.0;
    double work = 0.0;
    (void)law.bilateral_step(state, x, 1e-3);
    for (int tick = 0; tick < 5000; ++tick) {
      // The force at the end of a tick; half of what the tick adds is still to come over the tick.
      const double travel = step(random);
      x += travel;
      const double force = law.bilateral_step(state, x, 1e-3);
      work += force * travel;
      ASSERT_GE(work, law.stored_energy(state)) << "order " << order << ", tick " << tick;
    }
  }
}

TEST(Springpot, ForgetsALongRestWithoutDenormalNumbers) {
  const auto law = springpot(0.5);
  Springpot<double>::State state;
  (void)law.step(state, {}, 1e-3);
  (void)law.step(state, {.penetration = 1e-3}, 1e-3);
  for (int tick = 0; tick < 100000; ++tick) (void)law.step(state, {.penetration = 1e-3}, 1e-3);
  for (const double displacement : state.displacement) {
    EXPECT_TRUE(displacement == 0.0 || std::abs(displacement) >= 1e-100);
  }
  EXPECT_EQ(state.displacement.front(), 0.0);
}

}  // namespace
}  // namespace kerf::models
