#include "stability/controllers/transparency.h"

#include <cmath>
#include <complex>
#include <limits>

#include <gtest/gtest.h>

#include "stability/controllers/controlled_theory.h"
#include "stability/controllers/controller_design.h"
#include "stability/zwidth/wall_search.h"
#include "stability/zwidth/z_width.h"

namespace kerf::bench {
namespace {

SampledDevice held(double delay_periods) {
  return {.mass_kg = 0.08,
          .viscous_n_s_per_m = 0.5,
          .delay_s = 1e-3 * delay_periods,
          .velocity_corner_rad_s = 126.0,
          .hand = {.mass_kg = 0.1, .damping_n_s_per_m = 4.0, .stiffness_n_per_m = 300.0}};
}

/// A trial's force in a simulated loop.
class TrialForce {
 public:
  TrialForce(TransparencyTrial& trial, double period_s) : trial_(&trial), period_s_(period_s) {}
  double operator()(const AxisReading& reading) noexcept {
    sample_.position[0] = reading.position_m;
    sample_.velocity[0] = reading.speed_m_s;
    return trial_->step(sample_, period_s_).force[0];
  }

 private:
  TransparencyTrial* trial_;
  double period_s_;
  drivers::Sample sample_;
};

Transparency measured(const ControllerDesign& design, const SampledDevice& device, const Wall& wall) {
  const drivers::AxisInfo axis{.name = "x",
                               .position_unit = "m",
                               .force_unit = "N",
                               .resolution = device.encoder_step_m,
                               .force_limit = 50.0};
  TransparencyTrial trial(axis, 0, device.period_s, design, wall, {});
  SampledLoop<TrialForce> loop(device, {trial, device.period_s}, {});
  for (std::uint64_t tick = 0; tick < trial.max_ticks() && !trial.finished(); ++tick) loop.step();
  return transparency_of(trial, wall, device, {});
}

TEST(Transparency, OfALinearControllerIsThatOfTheExactlySampledLoop) {
  const Wall wall{.stiffness_n_per_m = 600.0, .damping_n_s_per_m = 0.5};
  for (const double delay_periods : {0.0, 1.4}) {
    const SampledDevice device = held(delay_periods);
    for (const WallController controller :
         {WallController::none, WallController::damping, WallController::coupling, WallController::exact}) {
      const ControllerDesign design = design_controller(controller, device);
      const ControlledSystem system(design, device, wall);
      const Transparency found = measured(design, device, wall);
      ASSERT_TRUE(found.finished) << name_of(controller);
      EXPECT_GT(found.lines.size(), 30U);
      for (const RenderedLine& line : found.lines) {
        const std::complex<double> truth = system.loop_impedance(line.frequency_hz);
        EXPECT_LT(std::abs(line.loop - truth), 1e-3 * std::abs(truth))
            << name_of(controller) << " at " << line.frequency_hz;
        EXPECT_GT(line.coherence.value, 0.999);
      }
    }
  }
}

TEST(Transparency, OfAHeldSpringIsItsHalfTickLate) {
  // K / (j w) exp(-j w T / 2), nearly: at 30 Hz 9.4 % of |Z|; rms over the band as of the sum of squares.
  const SampledDevice device = held(0.0);
  const Transparency found = measured({.device = device}, device, {.stiffness_n_per_m = 600.0});
  const double last = std::abs(found.lines.back().loop / found.lines.back().commanded - 1.0);
  EXPECT_NEAR(last, 2.0 * std::sin(0.25 * 2.0 * 3.141592653589793 * found.lines.back().frequency_hz * 1e-3),
              2e-3);
  EXPECT_LT(found.error.loop_db, 0.02) << "late, and not too soft";
}

TEST(Transparency, OfWhatTheHandFeelsHasTheDevicesMassAndFriction) {
  const SampledDevice device = held(0.0);
  const Transparency found = measured({.device = device}, device, {.stiffness_n_per_m = 600.0});
  for (const RenderedLine& line : found.lines) {
    const std::complex<double> own(0.5, 2.0 * 3.141592653589793 * line.frequency_hz * 0.08);
    EXPECT_LT(std::abs(line.felt - line.loop - own), 1e-9);
  }
}

TEST(Transparency, IsLessCoherentWhereFrictionHolds) {
  SampledDevice device = held(0.0);
  device.coulomb_n = 0.15;
  device.encoder_step_m = 2e-5;
  const Wall wall{.stiffness_n_per_m = 600.0};
  const Transparency rough = measured({.device = device}, device, wall);
  EXPECT_LT(rough.lines.back().coherence.value, 1.0);
  EXPECT_LT(rough.lines.back().coherence.lower, rough.lines.back().coherence.value);
  // The wall's commands still follow from the readings: what is rendered is known all the same.
  EXPECT_NEAR(std::abs(rough.lines.front().loop / rough.lines.front().commanded), 1.0, 0.02);
}

TEST(Transparency, IsExcitedByAsLittleAsTells) {
  SampledDevice device = held(0.0);
  EXPECT_EQ(designed_push(device, {.stiffness_n_per_m = 600.0}, 1.0, 8.0), 1.0);
  device.coulomb_n = 0.5;
  EXPECT_EQ(designed_push(device, {.stiffness_n_per_m = 600.0}, 1.0, 8.0), 2.0);
  device.encoder_step_m = 2e-4;
  EXPECT_NEAR(designed_push(device, {.stiffness_n_per_m = 600.0}, 1.0, 8.0), 2.4, 1e-12);
  EXPECT_EQ(designed_push(device, {.stiffness_n_per_m = 60'000.0}, 1.0, 8.0), 4.0) << "half of the stop";
}

TEST(Transparency, OfAWallThatDoesNotHoldIsNone) {
  const SampledDevice device = held(4.0);
  const Transparency found = measured({.device = device}, device, {.stiffness_n_per_m = 20'000.0});
  EXPECT_FALSE(found.finished);
  EXPECT_EQ(found.error.lines, 0U);
  EXPECT_TRUE(std::isnan(found.error.loop_share));
}

TEST(ExactWall, HoldsWhereAHeldWallRings) {
  const SampledDevice device = held(2.0);
  WallSearchOptions search{.stiffest_n_per_m = 20'000.0, .resolution = 0.05, .repeats = 2};
  const double alone = search_model(device, search).at(0).boundary();
  EXPECT_NEAR(alone, eigenvalue_boundary(device, 0.0, 50.0, 20'000.0), 0.05 * alone);
  search.controller = {.controller = WallController::exact, .device = device};
  const WallRung exact = search_model(device, search).at(0);
  const double truth = controlled_boundary(search.controller, device, 0.0, 50.0, 20'000.0);
  EXPECT_GT(truth, 5.0 * alone);
  EXPECT_NEAR(exact.boundary(), truth, 0.06 * truth);
}

TEST(WallSearch, RefusesAControllerOfAnotherRate) {
  SampledDevice device = held(0.0);
  device.period_s = 2e-3;
  const WallSearchOptions search{.controller = {.controller = WallController::exact, .device = device}};
  EXPECT_THROW(check(search, 1e-3), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
