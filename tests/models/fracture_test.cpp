#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/fracture.h>

namespace kerf::models {
namespace {

using Mode = Fracture<double>::Mode;

/// In vivo intestine of [Sepulveda2008]: 2 N at the yield energy, and 2 N while cutting.
const Fracture<double> intestine{4.3e-7, 13.0, 0.0153846120769, 2000.0, 1e-3, 0.1};

TEST(Fracture, YieldsWhereTheStoredEnergyReachesTheCheckValue) {
  EXPECT_NEAR(intestine.yield_depth() / 0.118097136991, 1.0, 1e-10);
  EXPECT_NEAR(intestine.cutting_force(), 2.0, 1e-15);
}

TEST(Fracture, FollowsFigureSeven) {
  Fracture<double>::State state;
  std::vector<Mode> modes;
  std::vector<double> forces;
  for (int tick = 0; tick <= 1000; ++tick) {  // 150 mm in at 0.3 m/s, then back out
    const double x = tick <= 500 ? 0.3e-3 * tick : 0.15 - 0.3e-3 * (tick - 500);
    forces.push_back(intestine.step(state, {x, tick <= 500 ? 0.3 : -0.3}, 1e-3));
    modes.push_back(state.mode);
  }
  const auto count = [&](Mode mode) { return std::count(modes.begin(), modes.end(), mode); };
  EXPECT_EQ(count(Mode::fracture), 1) << "one sample of 1 ms";
  const auto fracture =
      static_cast<std::size_t>(std::find(modes.begin(), modes.end(), Mode::fracture) - modes.begin());
  EXPECT_NEAR(forces[fracture - 1], 2.0, 0.1) << "deformation up to the yield point";
  EXPECT_EQ(forces[fracture], 0.0);
  for (std::size_t tick = fracture + 1; tick <= 500; ++tick) {
    ASSERT_EQ(modes[tick], Mode::cutting);
    ASSERT_DOUBLE_EQ(forces[tick], 2.0);
  }
  for (std::size_t tick = 501; tick <= 1000; ++tick) ASSERT_EQ(forces[tick], 0.0) << "free on the way back";
}

TEST(Fracture, TheSurfaceStaysAtTheTipOfTheCrack) {
  Fracture<double>::State state;
  double x = 0.0;
  for (; x < 0.14; x += 1e-4) (void)intestine.step(state, {x, 0.1}, 1e-3);
  const double tip = state.surface;
  for (double back = tip; back > 0.0; back -= 1e-4) EXPECT_EQ(intestine.step(state, {back, -0.1}, 1e-3), 0.0);
  EXPECT_EQ(state.surface, tip);
  EXPECT_EQ(intestine.step(state, {tip - 1e-6, 0.1}, 1e-3), 0.0);
  EXPECT_GT(intestine.step(state, {tip + 1e-6, 0.1}, 1e-3), 0.0);
}

TEST(Fracture, ACrackThatRunsAheadLeavesTheToolFreeUntilItsTip) {
  const Fracture<double> brittle{1.0, 1.0, 1e-3, 1.0, 1e-3, 0.1};  // da = 1 m at Uy = 1 mJ
  Fracture<double>::State state;
  double x = 0.0;
  while (state.mode != Mode::fracture) (void)brittle.step(state, {x += 1e-5, 0.01}, 1e-3);
  EXPECT_NEAR(state.crack_length, 1.0, 0.02);
  EXPECT_EQ(brittle.step(state, {x + 1e-5, 0.01}, 1e-3), 0.0);
  EXPECT_EQ(state.mode, Mode::free);
  EXPECT_GT(brittle.step(state, {state.surface + 1e-5, 0.01}, 1e-3), 0.0);
}

TEST(Fracture, TheBooksCloseOverRandomStrokes) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Fracture<double> tissue{4.3e-3, 4.0, 2e-3, 2000.0, 1e-3, 0.1, seed % 2 == 0 ? 0.0 : 2e-3};
    std::mt19937_64 random(seed);
    std::normal_distribution<double> push(0.0, 1.0);
    Fracture<double>::State state;
    double x = 0.0;
    double v = 0.0;
    double turnover = 0.0;
    double before = 0.0;
    for (int tick = 0; tick < 5000; ++tick) {
      v = 0.99 * v + 0.05 * push(random);
      x += 1e-3 * v;
      (void)tissue.step(state, {x, v}, 1e-3);
      turnover += std::abs(state.work - before);
      before = state.work;
      ASSERT_NEAR(state.work, state.stored + state.crack_energy, 1e-9 + 1e-6 * turnover) << seed;
      ASSERT_GE(state.work, -1e-15) << "it never gives what it did not take";
    }
    ASSERT_NEAR(state.crack_energy, tissue.cutting_force() * state.crack_length, 1e-9 + 1e-6 * turnover);
  }
}

TEST(Fracture, TheBooksAreThoseOfTheRenderedForce) {
  // Simpson would do better; at steps of 2 um the trapezoid is within the force of one step.
  Fracture<double>::State state;
  double work = 0.0;
  double before = 0.0;
  const double step = 2e-6;
  for (double x = step; x < 0.14; x += step) {
    const double force = intestine.step(state, {x, 0.1}, 1e-3);
    work += 0.5 * (before + force) * step;
    before = force;
  }
  EXPECT_NEAR(state.work / work, 1.0, 1e-3);
}

TEST(Fracture, WhatItSpendsDoesNotDependOnThePeriod) {
  // Uy at the fracture, then Fc along the rest of the way from the yield point.
  for (const double step : {1e-6, 1e-4, 5e-3, 0.2}) {
    Fracture<double>::State state;
    double x = 0.0;
    while (x < 0.2 - 1e-9) (void)intestine.step(state, {x = std::min(x + step, 0.2), 0.1}, 1e-3);
    const double cut = 2.0 * (0.2 - intestine.yield_depth());
    EXPECT_NEAR(state.crack_energy, 0.0153846120769 + cut, 1e-12) << step;
    EXPECT_NEAR(state.surface, 0.2, 1e-12);
    EXPECT_NEAR(state.work, state.crack_energy, 1e-12);
  }
}

TEST(Fracture, BegunDeepInTheTissueItIsCutThereAndStaysFinite) {
  Fracture<double>::State state;
  EXPECT_EQ(intestine.step(state, {10.0, 0.1}, 1e-3), 0.0);
  EXPECT_EQ(state.surface, 10.0);
  EXPECT_TRUE(std::isfinite(state.work));
  EXPECT_NEAR(intestine.step(state, {10.001, 0.1}, 1e-3), 2.0, 1e-12);
}

/// Crack after 10 s at 14 mm/s by a hand that trembles by 0.5 mm at 10 Hz, which turns it back every time
/// [m].
double crack_of_a_trembling_hand(double hysteresis_m) {
  Fracture<double> tissue = intestine;
  tissue.hysteresis = hysteresis_m;
  Fracture<double>::State state;
  constexpr double tremor_rad_s = 2.0 * std::numbers::pi * 10.0;
  for (int tick = 0; tick <= 10000; ++tick) {
    const double t = 1e-3 * tick;
    (void)tissue.step(state,
                      {0.014 * t + 5e-4 * std::sin(tremor_rad_s * t),
                       0.014 + 5e-4 * tremor_rad_s * std::cos(tremor_rad_s * t)},
                      1e-3);
  }
  return state.crack_length;
}

TEST(Fracture, TremorEndsTheCutUnlessThereIsHysteresis) {
  const double way_m = 0.14 - intestine.yield_depth();
  const double at_yield_m = intestine.yield_energy / intestine.cutting_force();
  EXPECT_LT(crack_of_a_trembling_hand(0.0), at_yield_m + 2e-3) << "the paper's, which yields once";
  EXPECT_NEAR(crack_of_a_trembling_hand(2e-3), at_yield_m + way_m, 1e-3) << "all the way";
  EXPECT_LT(crack_of_a_trembling_hand(2e-4), at_yield_m + 2e-3) << "less than the tremor";
}

TEST(Fracture, WithHysteresisIsFreeOnTheWayBackAndCutsOnAtTheTip) {
  Fracture<double> tissue = intestine;
  tissue.hysteresis = 2e-3;
  Fracture<double>::State state;
  for (double x = 0.0; x < 0.14; x += 1e-4) (void)tissue.step(state, {x, 0.1}, 1e-3);
  const double tip = state.surface;
  EXPECT_EQ(tissue.step(state, {tip, 0.0}, 1e-3), 0.0);
  EXPECT_EQ(tissue.step(state, {tip - 1.9e-3, -0.1}, 1e-3), 0.0);
  EXPECT_EQ(tissue.step(state, {tip - 1e-3, 0.1}, 1e-3), 0.0);
  EXPECT_DOUBLE_EQ(tissue.step(state, {tip + 1e-4, 0.1}, 1e-3), 2.0);
  EXPECT_EQ(tissue.step(state, {tip - 2.1e-3, -0.1}, 1e-3), 0.0);
  EXPECT_EQ(state.mode, Mode::free) << "drawn back by more";
  EXPECT_LT(tissue.step(state, {tip + 2e-4, 0.1}, 1e-3), 1e-3) << "has to be deformed anew";
}

TEST(Fracture, OneSampleOfFractureAtAnyRate) {
  for (const double period_s : {1e-2, 1e-3, 1e-4}) {
    Fracture<double>::State state;
    int fractures = 0;
    for (double x = 0.0; x < 0.14; x += 0.3 * period_s) {
      (void)intestine.step(state, {x, 0.3}, period_s);
      fractures += state.mode == Mode::fracture;
    }
    EXPECT_EQ(fractures, 1);
  }
}

}  // namespace
}  // namespace kerf::models
