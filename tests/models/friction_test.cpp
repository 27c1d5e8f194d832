#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/friction.h>

namespace kerf::models {
namespace {

constexpr double coulomb = 0.8;
constexpr double presliding = 2e-3;
constexpr Friction<double> dry{.coulomb = coulomb, .presliding = presliding};

double at(const Friction<double>& law, Friction<double>::State& state, double x, double velocity = 0.0) {
  return law.step(state, {.penetration = x, .velocity = velocity}, 1e-3);
}

TEST(Friction, BuildsUpOverThePreslidingDisplacement) {
  Friction<double>::State state;
  EXPECT_EQ(at(dry, state, 0.1), 0.0) << "at rest wherever the tool is";
  EXPECT_NEAR(at(dry, state, 0.1 + presliding), coulomb * (1.0 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(at(dry, state, 0.2), coulomb, 1e-12);
  // Back from there: z = -1 + 2 exp(-s / xd), which is zero at xd log 2.
  EXPECT_NEAR(at(dry, state, 0.2 - presliding * std::numbers::ln2), 0.0, 1e-12);
  EXPECT_NEAR(at(dry, state, 0.1), -coulomb, 1e-12);
}

TEST(Friction, KeepsItsForceAtRest) {
  Friction<double>::State state;
  (void)at(dry, state, 0.0);
  const double sliding = at(dry, state, 1e-3);
  for (int tick = 0; tick < 100; ++tick) EXPECT_EQ(at(dry, state, 1e-3), sliding);
}

TEST(Friction, DoesNotDependOnTheNumberOfTicksNorOnTheSpeed) {
  for (const int pieces : {2, 7, 1000}) {
    Friction<double>::State whole;
    Friction<double>::State parts;
    (void)at(dry, whole, 0.0);
    (void)at(dry, parts, 0.0);
    double expected = 0.0;
    double force = 0.0;
    for (const double corner : {3e-3, -1e-3, 0.5e-3}) {
      const double from = parts.penetration;
      expected = at(dry, whole, corner);
      for (int piece = 1; piece <= pieces; ++piece) {
        force = at(dry, parts, from + (corner - from) * piece / pieces);
      }
    }
    EXPECT_NEAR(force, expected, 1e-13) << pieces;
  }
}

TEST(Friction, TakesTheClosedFormOfACycleAtAnySpeed) {
  // Its steady loop between -X and X: 4 Fc (X - xd tanh(X / xd)).
  for (const double reach : {1e-3, 5e-3, 50e-3}) {
    const double expected = 4.0 * coulomb * (reach - presliding * std::tanh(reach / presliding));
    for (const int ticks : {4000, 20000}) {
      Friction<double>::State state;
      double energy = 0.0;
      double before = at(dry, state, -reach);
      double last = -reach;
      for (int tick = 1; tick <= 40 * ticks; ++tick) {
        const double x = -reach * std::cos(2.0 * std::numbers::pi * tick / ticks);
        const double force = at(dry, state, x);
        if (tick > 39 * ticks) energy += 0.5 * (before + force) * (x - last);
        before = force;
        last = x;
      }
      EXPECT_NEAR(energy / expected, 1.0, 1e-4) << "reach " << reach << ", " << ticks << " ticks a cycle";
    }
  }
}

TEST(Friction, BecomesCoulombsAsThePreslidingVanishes) {
  const Friction<double> sharp{.coulomb = coulomb, .presliding = 1e-9};
  Friction<double>::State state;
  (void)at(sharp, state, 0.0);
  for (int tick = 1; tick < 1000; ++tick) {
    const double velocity = std::cos(0.05 * tick);
    const double x = std::sin(0.05 * tick);
    const double travel = x - state.penetration;
    EXPECT_NEAR(at(sharp, state, x, velocity), std::copysign(coulomb, travel), 1e-12) << tick;
  }
}

TEST(Friction, AddsOffsetSpringAndViscosityOnBothSidesOfZero) {
  const Friction<double> law{
      .offset = -0.1, .stiffness = -3.0, .viscosity = -0.5, .coulomb = 0.0, .presliding = 1e-3};
  Friction<double>::State state;
  EXPECT_NEAR(at(law, state, 0.2, 0.4), -0.1 - 0.6 - 0.2, 1e-15);
  EXPECT_NEAR(at(law, state, -0.2, -0.4), -0.1 + 0.6 + 0.2, 1e-15);
}

TEST(Friction, GivesBackNoMoreThanItSays) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> step(0.0, 0.3 * presliding);
  Friction<double>::State state;
  double x = 0.0;
  double work = 0.0;
  double before = at(dry, state, x);
  for (int tick = 0; tick < 5000; ++tick) {
    const double last = x;
    const double end = x + step(random);
    for (int piece = 1; piece <= 50; ++piece) {
      const double next = last + (end - last) * piece / 50.0;
      const double force = at(dry, state, next);
      work += 0.5 * (before + force) * (next - x);
      before = force;
      x = next;
    }
    ASSERT_GE(work, dry.recoverable_energy(state) - 1e-9) << tick;
    ASSERT_LE(std::abs(state.slip), 1.0);
  }
}

TEST(Friction, StoresTheEnergyOfItsSpringHoweverSoftThatIs) {
  for (const double stiffness : {0.25, 400.0}) {
    const Friction<double> law{.stiffness = stiffness, .coulomb = coulomb, .presliding = presliding};
    Friction<double>::State state;
    (void)at(law, state, 0.0);
    (void)at(law, state, 0.1);
    const double spring = 0.5 * stiffness * 0.1 * 0.1;
    EXPECT_NEAR(law.stored_energy(state), law.recoverable_energy(state) + spring, 1e-12 * spring);
  }
}

TEST(Friction, GivesBackAllOfThatWhenItIsUnbent) {
  // From z > 0 straight back to z = 0, where the force vanishes.
  Friction<double>::State state;
  (void)at(dry, state, 0.0);
  (void)at(dry, state, 3e-3);
  const double recoverable = dry.recoverable_energy(state);
  double before = coulomb * state.slip;
  double back = 0.0;
  for (int i = 1; i <= 30000; ++i) {
    const double force = std::max(at(dry, state, 3e-3 - 1e-7 * i), 0.0);
    back += 0.5 * (before + force) * 1e-7;
    before = force;
  }
  EXPECT_NEAR(back / recoverable, 1.0, 1e-3);
}

}  // namespace
}  // namespace kerf::models
