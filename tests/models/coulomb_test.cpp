#include <cmath>

#include <gtest/gtest.h>

#include <kerf/models/coulomb.h>

namespace kerf::models {
namespace {

constexpr Coulomb<double> law{.stiffness = 200.0, .coulomb = 0.8, .presliding = 1e-3};

TEST(Coulomb, SticksAsASpringAndThenSlips) {
  Coulomb<double>::State state;
  EXPECT_DOUBLE_EQ(law.step(state, {0.0, 0.0}, 1e-3), 0.0);
  EXPECT_NEAR(law.step(state, {0.5e-3, 1.0}, 1e-3), 0.1 + 0.4, 1e-12) << "half of the presliding";
  EXPECT_NEAR(law.step(state, {5e-3, 1.0}, 1e-3), 1.0 + 0.8, 1e-12);
  EXPECT_NEAR(law.step(state, {4e-3, -1.0}, 1e-3), 0.8 + 0.0, 1e-12) << "it has turned by xd";
  EXPECT_NEAR(law.step(state, {2e-3, -1.0}, 1e-3), 0.4 - 0.8, 1e-12);
}

TEST(Coulomb, TakesTheSameFromACycleAtAnySpeed) {
  constexpr double reach = 0.01;
  for (const int ticks : {1000, 4000}) {
    Coulomb<double>::State state;
    double work = 0.0;
    double last_force = 0.0;
    double last = 0.0;
    for (int tick = 0; tick <= 2 * ticks; ++tick) {
      const double x = reach * std::sin(2.0 * std::acos(-1.0) * tick / ticks);
      const double force = law.step(state, {x, 0.0}, 1e-3);
      if (tick > ticks) work += 0.5 * (force + last_force) * (x - last);  // the second cycle
      last_force = force;
      last = x;
    }
    EXPECT_NEAR(work, 4.0 * 0.8 * (reach - 1e-3), 2e-5);
  }
}

}  // namespace
}  // namespace kerf::models
