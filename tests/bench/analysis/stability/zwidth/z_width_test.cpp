#include "stability/zwidth/z_width.h"

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stability/wall/wall_theory.h"
#include "stability/zwidth/model_device.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

const std::atomic<bool> never{false};

ZWidth measured(const SampledDevice& device, const WallSearchOptions& search) {
  ModelDevice open(device);
  return measure_z_width(open, {.search = search}, never);
}

SampledDevice in_light_grip(double viscous, double delay_periods) {
  return {.mass_kg = 0.08,
          .viscous_n_s_per_m = viscous,
          .delay_s = 1e-3 * delay_periods,
          .velocity_corner_rad_s = 400.0,
          .hand = {.mass_kg = 0.1, .damping_n_s_per_m = 2.0, .stiffness_n_per_m = 200.0}};
}

TEST(ZWidth, OfALinearDeviceIsThatOfItsEigenvalues) {
  const WallSearchOptions search{.damping_n_s_per_m = {0.0, 3.0}};
  for (const double delay_periods : {0.0, 1.6}) {
    const SampledDevice device = in_light_grip(0.5, delay_periods);
    const ZWidth found = measured(device, search);
    ASSERT_TRUE(found.finished);
    EXPECT_EQ(found.missed, 0U);
    for (const WallRung& rung : found.ladder) {
      ASSERT_EQ(rung.end, SearchEnd::found);
      const double truth = eigenvalue_boundary(device, rung.damping_n_s_per_m, 50.0, 20'000.0);
      EXPECT_NEAR(rung.boundary(), truth, 0.05 * truth) << rung.damping_n_s_per_m;
      EXPECT_LT(rung.held_n_per_m, rung.failed_n_per_m);
    }
  }
}

TEST(ZWidth, ThroughTheLoopIsThatOfTheSimulationWithCoulombFrictionAndEncoder) {
  SampledDevice device = in_light_grip(0.5, 0.4);
  device.coulomb_n = 0.05;
  device.encoder_step_m = 2e-5;
  const WallSearchOptions search{.damping_n_s_per_m = {1.0}, .resolution = 0.04};
  const ZWidth through = measured(device, search);
  const WallRung& through_loop = through.ladder.at(0);
  const WallRung simulated = search_model(device, through.options).at(0);
  EXPECT_EQ(through_loop.end, SearchEnd::found);
  EXPECT_NEAR(through_loop.boundary(), simulated.boundary(), 0.05 * simulated.boundary());
}

TEST(ZWidth, SaysWhereABoundaryHasAHysteresis) {
  // Coulomb friction holds a soft strike and not a hard one.
  SampledDevice device{.mass_kg = 0.08, .viscous_n_s_per_m = 0.3, .coulomb_n = 0.1};
  EXPECT_TRUE(
      measured(device, {.resolution = 0.1, .soft_strike = 0.05, .rest_s = 5.0}).ladder.at(0).hysteresis);
  device.coulomb_n = 0.0;
  EXPECT_FALSE(measured(device, {.resolution = 0.1}).ladder.at(0).hysteresis)
      << "struck with 0.2 N, it grows past what is felt";
}

TEST(ZWidth, IsNotWhatAHandDoesNotFeel) {
  // A coarse encoder and a damped wall: a limit cycle of some 0.1 N from soft walls on.
  SampledDevice device = in_light_grip(0.5, 0.0);
  device.encoder_step_m = 1e-4;
  WallSearchOptions search{.damping_n_s_per_m = {4.0}, .stiffest_n_per_m = 400.0, .resolution = 0.1};
  search.felt_n = 2e-3;
  const WallRung fine = measured(device, search).ladder.at(0);
  EXPECT_EQ(fine.end, SearchEnd::found);
  EXPECT_GT(fine.cycle_n, 2e-3);
  search.felt_n = 2.0 * fine.cycle_n + 0.1;
  EXPECT_EQ(measured(device, search).ladder.at(0).end, SearchEnd::holds_throughout);
}

TEST(ZWidth, TellsWhatHoldsThroughoutAndNowhere) {
  const SampledDevice device = in_light_grip(0.5, 0.0);
  const WallRung soft = measured(device, {.softest_n_per_m = 50.0, .stiffest_n_per_m = 100.0}).ladder.at(0);
  EXPECT_EQ(soft.end, SearchEnd::holds_throughout);
  EXPECT_EQ(soft.held_n_per_m, 100.0);
  const WallRung stiff =
      measured(device, {.softest_n_per_m = 50'000.0, .stiffest_n_per_m = 60'000.0}).ladder.at(0);
  EXPECT_EQ(stiff.end, SearchEnd::holds_nowhere);
  EXPECT_EQ(stiff.held_n_per_m, 0.0);
}

TEST(ZWidth, StoppedEarlyKeepsWhatItFound) {
  const std::atomic<bool> stopped{true};
  ModelDevice open(in_light_grip(0.5, 0.0));
  const ZWidth found = measure_z_width(open, {}, stopped);
  EXPECT_FALSE(found.finished);
  EXPECT_EQ(found.ladder.at(0).end, SearchEnd::not_finished);
}

TEST(ZWidth, TheBandOfAnUncertainModelHoldsItsBoundary) {
  UncertainModel model{.device = in_light_grip(0.5, 0.0)};
  const WallSearchOptions search{.damping_n_s_per_m = {0.0, 2.0}};
  EXPECT_FALSE(z_width_theory(model, search).at(0).band);
  model.viscous = model.hand = 0.1;
  const auto theory = z_width_theory(model, search, 200, 2);
  // Friction of device and hand by the square root of the sum of squares, nearly: 2 (b + B) / T.
  const double share = std::hypot(0.1 * 0.5, 0.1 * 2.0) / 2.5;
  EXPECT_NEAR(theory[0].band->end / theory[0].boundary - 1.0, share, 0.35 * share);
  EXPECT_NEAR(1.0 - theory[0].band->begin / theory[0].boundary, share, 0.35 * share);
  EXPECT_LT(theory[0].passive, theory[0].band->begin);
}

TEST(ZWidth, RefusesWhatItCannotSearch) {
  const auto refusal = [](const WallSearchOptions& search) {
    try {
      (void)measured(in_light_grip(0.5, 0.0), search);
    } catch (const std::invalid_argument& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal({.damping_n_s_per_m = {}}), HasSubstr("no damping"));
  EXPECT_THAT(refusal({.softest_n_per_m = 10.0, .stiffest_n_per_m = 5.0}),
              HasSubstr("the stiffest wall is 5"));
  EXPECT_THAT(refusal({.strike_n = 90.0}), HasSubstr("give a weaker one"));
  EXPECT_THAT(refusal({.window_s = 2.0}), HasSubstr("three windows"));
  ModelDevice open(in_light_grip(0.5, 0.0));
  EXPECT_THROW((void)measure_z_width(open, {.axis = "y"}, never), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
