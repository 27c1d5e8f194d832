#include <cmath>

#include <gtest/gtest.h>

#include <kerf/models/branch.h>

namespace kerf::models {
namespace {

TEST(BranchSelector, FollowsTheSignOfTheVelocity) {
  const BranchSelector selector;
  BranchSelector::State state;
  EXPECT_TRUE(selector.step(state, {.penetration = 0.0, .velocity = 0.1}, 1e-3).closing);
  EXPECT_FALSE(selector.step(state, {.penetration = 0.0, .velocity = -0.1}, 1e-3).closing);
  EXPECT_FALSE(selector.step(state, {.penetration = 0.0, .velocity = 0.0}, 1e-3).closing)
      << "the last one goes on";
}

TEST(BranchSelector, FadesInWithTheTravelSinceTheReversal) {
  const BranchSelector selector{.reversal_scale = 50.0};
  BranchSelector::State state;
  (void)selector.step(state, {.penetration = 0.30, .velocity = 1.0}, 1e-3);
  EXPECT_NEAR(selector.step(state, {.penetration = 0.31, .velocity = 1.0}, 1e-3).scale, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(selector.step(state, {.penetration = 0.40, .velocity = 1.0}, 1e-3).scale, 1.0);
  EXPECT_DOUBLE_EQ(selector.step(state, {.penetration = 0.40, .velocity = -1.0}, 1e-3).scale, 0.0);
  EXPECT_NEAR(selector.step(state, {.penetration = 0.395, .velocity = -1.0}, 1e-3).scale, 0.25, 1e-12);
}

TEST(BranchSelector, FadesOutAroundZeroVelocity) {
  const BranchSelector selector{.ramp_band = 0.2};
  BranchSelector::State state;
  EXPECT_DOUBLE_EQ(selector.step(state, {.penetration = 0.0, .velocity = 0.3}, 1e-3).scale, 1.0);
  EXPECT_DOUBLE_EQ(selector.step(state, {.penetration = 0.0, .velocity = 0.05}, 1e-3).scale, 0.25);
  EXPECT_DOUBLE_EQ(selector.step(state, {.penetration = 0.0, .velocity = 0.0}, 1e-3).scale, 0.0);
}

TEST(BranchSelector, FiltersThePenetrationAtFirstOrderBeforeDifferencing) {
  const BranchSelector selector{.velocity_corner = 10.0, .ramp_band = 1.0};
  BranchSelector::State state;
  (void)selector.step(state, {.penetration = 0.0, .velocity = 0.0}, 1e-3);
  double scale = 0.0;
  // On a ramp the filtered velocity rises as 1 - exp(-10 t) of the true one.
  for (int tick = 1; tick <= 100; ++tick)
    scale = selector.step(state, {.penetration = 0.5e-3 * tick}, 1e-3).scale;
  EXPECT_NEAR(scale, 0.5 * (1.0 - std::exp(-1.0)), 2e-3);
}

}  // namespace
}  // namespace kerf::models
