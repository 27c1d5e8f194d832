#include "stability/plane/plane.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "stability/bisection.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench {
namespace {

// K T^2 / M = 0.01.
constexpr SampledDevice free_axis{.mass_kg = 0.1, .viscous_n_s_per_m = 0.4, .encoder_step_m = 1e-5};
constexpr double wall_n_per_m = 1000.0;

SampledDevice at(double viscous, double coulomb, double delay_periods = 0.0) {
  SampledDevice device = free_axis;
  device.delay_s = delay_periods * device.period_s;
  return device_at({.viscous = viscous, .coulomb = coulomb}, device, wall_n_per_m);
}

TEST(Plane, ItsNumbersAreThoseOfTheDeviceAndBack) {
  const PlanePoint there = plane_point(at(0.3, 2.5), wall_n_per_m);
  EXPECT_DOUBLE_EQ(there.viscous, 0.3);
  EXPECT_DOUBLE_EQ(there.coulomb, 2.5);
  const SampledDevice handle{.viscous_n_s_per_m = 0.2, .coulomb_n = 0.1, .encoder_step_m = 4e-5};
  EXPECT_DOUBLE_EQ(plane_point(handle, 400.0).viscous, 0.5);
  EXPECT_DOUBLE_EQ(plane_point(handle, 400.0).coulomb, 6.25);
  EXPECT_TRUE(std::isinf(plane_point({.coulomb_n = 0.1}, 400.0).coulomb));
}

TEST(Plane, ItsLinesAreThoseOfColgateAndSchenkelAndOfAbbottAndOkamura) {
  for (const double viscous : {0.1, 0.2, 0.7}) {
    for (const double coulomb : {0.005, 0.02}) {
      const SampledDevice device{
          .mass_kg = 0.1, .viscous_n_s_per_m = viscous, .coulomb_n = coulomb, .encoder_step_m = 3e-5};
      const double limit = abbott_okamura(device);
      const auto region = [&](double k) { return plane_region(plane_point(device, k), plane_lines(device)); };
      EXPECT_EQ(region(0.999 * limit), PlaneRegion::passive);
      EXPECT_NE(region(1.001 * limit), PlaneRegion::passive);
    }
  }
}

TEST(Plane, ADelayOfWholePeriodsMovesTheViscousLineAsThePassivityTheoremDoes) {
  for (const double periods : {0.0, 1.0, 3.0}) {
    const SampledDevice late = at(1.0, 1.0, periods);
    const double passive = passive_stiffness(late, 0.0);
    EXPECT_NEAR(plane_point(late, passive).viscous, 0.5 + periods, 1e-3);
    EXPECT_DOUBLE_EQ(plane_lines(late).viscous, 0.5 + periods);
  }
}

TEST(Plane, BeyondBothLinesEveryMotionEnds) {
  for (const double viscous : {0.52, 0.8, 3.0}) {
    for (const double coulomb : {0.51, 1.0, 4.0})
      EXPECT_EQ(plane_behaviour(at(viscous, coulomb), wall_n_per_m), PlaneBehaviour::dies_away)
          << viscous << coulomb;
  }
}

TEST(Plane, WeakCoulombFrictionLeavesALimitCycleHoweverViscous) {
  // Between two steps the wall is wrong by half a step's force, and less friction cannot hold that.
  for (const double viscous : {0.6, 2.0}) {
    const PlaneBehaviour behaviour = plane_behaviour(at(viscous, 0.45), wall_n_per_m);
    EXPECT_EQ(behaviour, PlaneBehaviour::small_cycle) << "half a step is 5 mN";
    EXPECT_EQ(plane_behaviour(at(viscous, 0.55), wall_n_per_m), PlaneBehaviour::dies_away);
  }
  SampledDevice coarse = at(0.6, 0.0);
  coarse.encoder_step_m = 2e-4;
  EXPECT_EQ(plane_behaviour(coarse, wall_n_per_m), PlaneBehaviour::cycle) << "half a step is 0.1 N";
}

TEST(Plane, CoulombFrictionLocksSmallMotionsAndNotLargeOnes) {
  EXPECT_EQ(plane_behaviour(at(0.2, 3.0), wall_n_per_m), PlaneBehaviour::locked);
  EXPECT_EQ(plane_behaviour(at(0.2, 0.1), wall_n_per_m), PlaneBehaviour::grows);
}

TEST(Plane, AFarSwingIsLockedUpToWhereItsEnergyIsBalanced) {
  // 4 f_c A against pi w A^2 (K T / 2 - b), for small K T^2 / M. A trial that is to double takes the boundary
  // to be further than it is, by 0.058 at most of these three.
  SampledDevice heavy = free_axis;
  heavy.mass_kg = 2.0;
  const PlaneTrial trial{.far_steps = 500.0};
  for (const double coulomb : {1.0, 2.0, 4.0}) {
    const double simulated =
        first_change({.lower = 0.02, .upper = 1.0, .share = 5e-3, .scan = 30}, [&](double below) {
          const PlanePoint point{.viscous = 0.5 - below, .coulomb = coulomb};
          if (point.viscous < 0.0) return false;
          return plane_behaviour(device_at(point, heavy, wall_n_per_m), wall_n_per_m, trial) ==
                 PlaneBehaviour::dies_away;
        });
    const double balanced = 0.5 - swing_line(heavy, wall_n_per_m, coulomb, 500.0);
    EXPECT_NEAR(simulated, balanced, 0.07) << coulomb;
  }
}

TEST(Plane, ItsMapDoesWhatTheLinesSayAwayFromThem) {
  const PlaneMap map = plane_map(at(1.0, 1.0), std::vector{wall_n_per_m}, 12, {}, {});
  const PlaneLines lines = plane_lines(map.device);
  std::size_t beside = 0;
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const PlanePoint point{.viscous = map.grid.first[i % 12], .coulomb = map.grid.second[i / 12]};
    if (std::abs(std::log(point.viscous / lines.viscous)) < 0.2 ||
        std::abs(std::log(point.coulomb / 0.5)) < 0.2)
      continue;
    const bool swings_stop = point.viscous > swing_line(map.device, wall_n_per_m, point.coulomb, 900.0);
    if (plane_region(point, lines) == PlaneRegion::locked && swings_stop)
      continue;  // all of it is locked there
    ++beside;
    EXPECT_TRUE(agree(map.cells[i], plane_region(point, lines)))
        << point.viscous << " " << point.coulomb << ": " << name_of(map.cells[i]);
  }
  EXPECT_GT(beside, 80U);
  EXPECT_EQ(map.walls.at(0).behaviour, PlaneBehaviour::dies_away);
}

TEST(Plane, RefusesADeviceWithoutEncoderSteps) {
  SampledDevice smooth = free_axis;
  smooth.encoder_step_m = 0.0;
  EXPECT_THROW((void)plane_behaviour(smooth, wall_n_per_m), std::invalid_argument);
  EXPECT_THROW((void)plane_map(free_axis, {}, 4, {}, {}), std::invalid_argument);
  EXPECT_THROW((void)plane_behaviour_named("hovers"), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
