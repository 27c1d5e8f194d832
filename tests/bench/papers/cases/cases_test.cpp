#include "cases/cases.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/hand.h>
#include <kerf/drivers/simulated_scissors.h>
#include <kerf/models/lattice.h>
#include <kerf/models/law.h>

#include "cases/control_cost.h"
#include "cases/controlled_wall.h"
#include "cases/document.h"
#include "files/whole_file.h"
#include "loop/safety.h"
#include "stability/device/in_hand.h"
#include "stability/law_force.h"

namespace kerf::bench {
namespace {

class EveryCase : public testing::TestWithParam<std::string_view> {
 protected:
  const NamedCase it = run_cases({std::string(GetParam())}, 1).front();
};

TEST_P(EveryCase, FailsWithoutItsRemedyAndHoldsWithIt) {
  EXPECT_FALSE(it.without.holds) << it.without.figure;
  EXPECT_TRUE(it.with.holds) << it.with.figure;
}

TEST_P(EveryCase, IsJudgedByItsNumberAndNothingElse) {
  EXPECT_GT(it.without.measured, 1.5 * it.limit + 1e-9) << "by a margin, not by a hair";
  EXPECT_LE(it.with.measured, it.limit);
  EXPECT_EQ(it.without.unit, it.with.unit);
}

TEST_P(EveryCase, SaysWhatItIsAndShowsBoth) {
  EXPECT_EQ(it.name, GetParam());
  for (const std::string& text :
       {it.where, it.what, it.remedy, it.quantity, it.theory, it.without.unit, it.without.figure,
        it.with.figure, it.picture.x_label, it.picture.y_label}) {
    EXPECT_FALSE(text.empty());
  }
  ASSERT_GE(it.picture.curves.size(), 2U);
  for (const Curve& curve : it.picture.curves) {
    EXPECT_GT(curve.x.size(), 5U) << curve.label;
    EXPECT_EQ(curve.x.size(), curve.y.size());
  }
}

TEST_P(EveryCase, IsTheSameForTheSameSeed) {
  const NamedCase again = run_cases({std::string(GetParam())}, 1).front();
  EXPECT_EQ(again.without.measured, it.without.measured);
  EXPECT_EQ(again.with.measured, it.with.measured);
  EXPECT_EQ(again.picture.curves.front().y, it.picture.curves.front().y);
}

INSTANTIATE_TEST_SUITE_P(Cases, EveryCase, testing::ValuesIn(case_names()),
                         [](const auto& about) { return std::string(about.param); });

TEST(Cases, AreRunInTheirOwnOrderAndByName) {
  const auto run = run_cases({"delay", "velocity_sign"}, 1);
  ASSERT_EQ(run.size(), 2U);
  EXPECT_EQ(run[0].name, "velocity_sign");
  EXPECT_EQ(run[1].name, "delay");
}

TEST(Cases, RefuseANameThatNoneHas) {
  EXPECT_THAT([] { (void)run_cases({"velocity_signs"}, 1); },
              testing::ThrowsMessage<std::invalid_argument>(testing::AllOf(
                  testing::HasSubstr("'velocity_signs'"), testing::HasSubstr("fast_contact"))));
}

/// Ripple of 1.5 N to and fro, chosen by the velocity's sign with a band, where a hand came back and rests.
double ripple_with_band(double band_rad_s) {
  const double values[] = {0.0, 1.0, 1.5, 1.5, -0.75, -0.75};
  const AxisLaw law{
      models::Law::make("piecewise", values, {{"segments", 1.0}, {"loop", true}, {"ramp_band", band_rad_s}}),
      drivers::SimulatedScissors::lever_m};
  SampledDevice device = scissors_handle();
  device.hand = drivers::usual_grip;
  device.velocity_corner_rad_s = 10.0;
  return ripple_n(run_loop(device, LawForce(law, device.period_s), {}, 2.0, [](double time_s) {
    return HandPush{.position_m = 8e-3 * drivers::MinimumJerk::at(time_s / 0.6).position -
                                  2e-3 * drivers::MinimumJerk::at((time_s - 0.7) / 0.3).position};
  }));
}

TEST(VelocitySign, NeedsABandWiderThanTheEncodersStepAllows) {
  const SampledDevice device = scissors_handle();
  const double narrowest =
      1.5 * 10.0 * device.encoder_step_m / (2.0 * device.coulomb_n * drivers::SimulatedScissors::lever_m);
  EXPECT_GT(ripple_with_band(0.6 * narrowest), felt_n);
  EXPECT_LT(ripple_with_band(3.0 * narrowest), felt_n);
}

TEST(EqualThresholds, AlternateAsOftenAsTheNoiseSays) {
  constexpr int seeds = 60;
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const NamedCase it = run_cases({"equal_thresholds"}, seed).front();
    sum += it.without.measured;
    EXPECT_EQ(it.with.measured, 2.0) << seed;
  }
  EXPECT_NEAR(sum / seeds, 4.0 * 0.02 / (std::sqrt(std::numbers::pi) * 1e-3), 0.05 * 45.0);
}

/// Force of a Kelvin solid by forward Euler so many ticks after a step in; an even number, as it turns about.
double arm_after(double period_s, int ticks) {
  const double values[] = {1e-9, 400.0, 400.0 * 0.4e-3};
  const models::Law tissue = models::Law::make("kelvin", values, {{"integrator", std::string("euler")}});
  auto state = tissue.initial_state();
  (void)tissue.step(state, models::Motion{}, period_s);
  double force = 0.0;
  for (int tick = 0; tick <= ticks; ++tick) {
    force = tissue.step(state, models::Motion{.penetration = 1e-3}, period_s).force;
  }
  return force;
}

TEST(EulerMaxwell, DivergesFromTwiceTheRelaxationTimeOn) {
  EXPECT_NEAR(arm_after(1e-3, 22) / arm_after(1e-3, 20), std::pow(1.0 - 1e-3 / 0.4e-3, 2), 1e-6);
  EXPECT_LT(arm_after(0.79e-3, 500), arm_after(0.79e-3, 0));
  EXPECT_GT(arm_after(0.81e-3, 500), arm_after(0.81e-3, 0));
}

/// Energy of the breathing mode of a single cell after some steps, over what it began with.
double breathing(double step_share) {
  const models::LatticeOptions cell{.columns = 2, .rows = 2};
  models::Lattice<double> lattice(cell);
  for (int node = 0; node < 4; ++node) {
    lattice.set_displacement(node, {node % 2 == 0 ? -1e-6 : 1e-6, node < 2 ? -1e-6 : 1e-6});
  }
  const double before = lattice.potential_energy();
  lattice.step(step_share * models::stable_step(cell), 2000);
  return (lattice.potential_energy() + lattice.kinetic_energy()) / before;
}

TEST(EulerLattice, BlowsUpFromTheStableStepOn) {
  EXPECT_LT(breathing(0.99), 1.0);
  EXPECT_GT(breathing(1.01), 1.0);
}

TEST(FractureAtLowRate, MissesHalfATicksTravelTimesTheForce) {
  const NamedCase it = run_cases({"fracture_at_low_rate"}, 1).front();
  const double noticed_n = 4.3e-7 * std::exp(13.0 * 0.12 / 0.1);  // the first tick of 2 mm past 118.1 mm
  EXPECT_NEAR(it.picture.curves[0].y.back(), 1e3 * 0.5 * noticed_n * 2e-3, 0.15) << "mJ";
  EXPECT_LT(it.picture.curves[1].y.back(), 1e-6);
}

TEST(Delay, AHandOnAWallVibratesFromTheEigenvaluesBoundaryOn) {
  SampledDevice late = linear_handle();
  late.hand = drivers::usual_grip;
  late.delay_s = 4e-3;
  const double boundary = eigenvalue_boundary(late, 0.0, 1.0, 1e6);
  const auto growth = [&](double stiffness) {
    const CaseTrace trace = run_loop(late, WallForce{{.stiffness_n_per_m = stiffness}, false}, {}, 2.0,
                                     [](double) { return HandPush{.position_m = 1e-4}; });
    return ripple_n(trace, 0.25) / ripple_n(trace, 0.75);
  };
  EXPECT_LT(growth(0.97 * boundary), 0.9);
  EXPECT_GT(growth(1.03 * boundary), 1.1);
}

/// Energy that a tool gains of a wall of 1000 N/m, at the mean over the moments of a tick [J].
double mean_gain(const SampledDevice& device, double speed) {
  constexpr int phases = 32;
  double sum = 0.0;
  for (int i = 0; i < phases; ++i) {
    SampledLoop loop(device, WallForce{{.stiffness_n_per_m = 1000.0}},
                     {.position_m = -speed * device.period_s * i / phases, .speed_m_s = speed});
    do {
      loop.step();
    } while (loop.motion().position_m > 0.0 || loop.motion().speed_m_s > 0.0);
    sum += 0.5 * device.moving_mass_kg() * (std::pow(loop.motion().speed_m_s, 2) - speed * speed);
  }
  return sum / phases;
}

TEST(FastContact, GainsPastFourOverPiTimesTheSpeedOfAbbottAndOkamura) {
  SampledDevice device = scissors_handle();
  device.encoder_step_m = 0.0;
  device.hand.mass_kg = 0.1;
  const double speed = 4.0 / std::numbers::pi * 0.1 / (0.5 * 1000.0 * 1e-3 - 0.2);
  EXPECT_LT(mean_gain(device, 0.9 * speed), 0.0);
  EXPECT_GT(mean_gain(device, 1.1 * speed), 0.0);
}

TEST(StiffGrip, TurnsTheEigenvaluesOut) {
  SampledDevice device = linear_handle();
  device.delay_s = 8e-3;
  const Wall tissue{.stiffness_n_per_m = 100.0, .damping_n_s_per_m = 14.2};
  device.hand = light_grip;
  EXPECT_LT(spectral_radius(device, tissue), 1.0);
  device.hand = stiffened_grip;
  EXPECT_GT(spectral_radius(device, tissue), 1.0);
  device.hand = firm_grip;
  EXPECT_LT(spectral_radius(device, tissue), 1.0) << "with all the mass and damping of the range";
}

TEST(StiffGrip, LiesWithinWhatWasMeasuredOfHands) {
  EXPECT_GE(stiffened_grip.mass_kg, light_grip.mass_kg);
  for (const HandImpedance& hand : {drivers::usual_grip, stiffened_grip}) {
    EXPECT_GE(hand.mass_kg, 0.1);
    EXPECT_LE(hand.mass_kg, 0.2);
    EXPECT_GE(hand.damping_n_s_per_m, 2.0);
    EXPECT_LE(hand.damping_n_s_per_m, 8.0);
    EXPECT_GE(hand.stiffness_n_per_m, 200.0);
    EXPECT_LE(hand.stiffness_n_per_m, 600.0);
  }
}

SampledDevice perfect_handle() {
  SampledDevice device = scissors_handle();
  device.encoder_step_m = 0.0;
  device.velocity_corner_rad_s = 0.0;
  return device;
}

/// What the controller adds to a wall that is entered at a constant speed.
double added_force(const SampledDevice& device, double stiffness, double speed) {
  const WallForce wall{{.stiffness_n_per_m = stiffness}};
  ControlledWall controlled(wall, device, {stiffness});
  AxisSensor sensor(device);
  double added_n = 0.0;
  for (int tick = -5; tick < 200; ++tick) {
    const AxisReading reading = sensor.read(speed * device.period_s * tick);
    added_n = std::abs(controlled(reading) - wall(reading));
  }
  return added_n;
}

TEST(PassivityControlled, NeverActsUpToThePassiveStiffness) {
  const SampledDevice device = perfect_handle();
  EXPECT_EQ(added_force(device, 0.99 * 400.0, 0.1), 0.0) << "2 b / T = 400 N/m";
  EXPECT_EQ(added_force(device, 0.1 * 400.0, 1.0), 0.0);
}

TEST(PassivityControlled, AddsOnlyTheDampingThatIsMissing) {
  const SampledDevice device = perfect_handle();
  double sum = 0.0;
  const WallForce wall{{.stiffness_n_per_m = 1600.0}};
  ControlledWall controlled(wall, device, {1600.0});
  AxisSensor sensor(device);
  constexpr int ticks = 1000;
  for (int tick = 0; tick < ticks; ++tick) {
    const AxisReading reading = sensor.read(0.1e-3 * tick);
    sum += std::abs(controlled(reading) - wall(reading)) / ticks;
  }
  EXPECT_NEAR(sum, (0.5 * 1600.0 * 1e-3 - 0.2) * 0.1, 0.02 * 0.06) << "(K T / 2 - b) v";
}

TEST(PassivityControlled, SavesNothingUpOnTheWayThroughFreeAir) {
  const SampledDevice device = perfect_handle();
  const WallForce wall{{.stiffness_n_per_m = 1600.0}};
  ControlledWall controlled(wall, device, {1600.0});
  AxisSensor sensor(device);
  double added_n = 0.0;
  for (int tick = -500; tick < 20; ++tick) {
    const AxisReading reading = sensor.read(0.1e-3 * tick);
    added_n += std::abs(controlled(reading) - wall(reading)) / 20.0;
  }
  EXPECT_NEAR(added_n, 0.06, 0.015);
}

/// A wall as the loop gives it to a hand: through Safety, with passivity control.
class SafeWall {
 public:
  SafeWall(const SampledDevice& device, double stiffness, bool says_what_it_stores)
      : wall_{{.stiffness_n_per_m = stiffness}},
        energy_{stiffness},
        says_(says_what_it_stores),
        safety_({.axes = {{.name = "theta",
                           .force_unit = "N",
                           .resolution = device.encoder_step_m,
                           .force_limit = 7.58,
                           .slew_limit = 2000.0,
                           .mechanics = drivers::Mechanics{.mass_kg = device.mass_kg,
                                                           .viscous_n_s_per_m = device.viscous_n_s_per_m}}}},
                {.period_s = device.period_s, .soft_start_s = 0.0, .passivity_control = true}) {}

  /// 20 mm at 2 N and 0.1 m/s, and back through free air.
  void cut() {
    for (int tick = 0; tick < 200; ++tick) (void)force_at(1e-4 * tick, -2.0, 0.0);
    for (int tick = 200; tick > 0; --tick) (void)force_at(1e-4 * tick, 0.0, 0.0);
  }
  double operator()(const AxisReading& reading) noexcept {
    const double stored_j = energy_(wall_, reading);
    return force_at(reading.position_m, wall_(reading), stored_j - std::exchange(stored_j_, stored_j));
  }

 private:
  double force_at(double position_m, double force_n, double stored_change_j) noexcept {
    (void)safety_.judge(drivers::Status::ok, {.position = {position_m}}, 1e-3);
    Command command{.force = {force_n}};
    if (says_) command.stored_change_j = stored_change_j;
    safety_.apply(command);
    return command.force[0];
  }

  WallForce wall_;
  WallEnergy energy_;
  bool says_;
  Safety safety_;
  double stored_j_ = 0.0;
};

TEST(PassivityControl, HoldsAStiffWallHoweverMuchWasCutBefore) {
  const SampledDevice device = weighted_scissors();
  for (const bool says_what_it_stores : {true, false}) {
    double after_none_n = 0.0;
    for (const int cuts : {0, 1, 5, 20, 100}) {
      SafeWall wall(device, 1600.0, says_what_it_stores);
      for (int cut = 0; cut < cuts; ++cut) wall.cut();
      const double ripple = ripple_n(lean_on(device, wall));
      RecordProperty(fmt::format("after_{}_cuts_{}", cuts, says_what_it_stores),
                     fmt::format("{:.4f} N", ripple));
      if (cuts == 0) after_none_n = ripple;
      EXPECT_LE(std::abs(ripple - after_none_n), 0.05) << cuts << " cuts";
      if (says_what_it_stores) {
        EXPECT_LE(ripple, 0.05) << cuts << " cuts";
      }
    }
  }
}

TEST(ControlCost, IsNothingOnAPassiveWallAndGrowsWithWhatIsMissing) {
  const ControlCosts costs = control_costs();
  ASSERT_GE(costs.rows.size(), 8U);
  EXPECT_EQ(costs.rows.front().share, 0.5);
  EXPECT_EQ(costs.rows.back().share, 4.0);
  for (const ControlCost& row : costs.rows) {
    EXPECT_TRUE(row.holds_with) << row.share;
    if (row.share < 1.0) {
      EXPECT_EQ(row.worst_n, 0.0) << row.share;
      EXPECT_TRUE(row.holds_without) << row.share;
    } else {
      EXPECT_LE(row.worst_n, (row.share - 1.0) * 0.2 * 0.19 + 1e-12) << row.share;
      EXPECT_GE(row.worst_n, (row.share - 1.0) * 0.2 * 0.13) << row.share;
    }
    EXPECT_LE(row.rms_n, row.worst_n);
    EXPECT_LE(row.rms_jnd, row.worst_jnd);
  }
  EXPECT_FALSE(costs.rows.back().holds_without);
}

TEST(Document, HasWhatTheBenchSays) {
  const std::filesystem::path docs = KERF_SOURCE_DIR "/docs";
  const auto cases = run_cases({}, 1);
  const ControlCosts costs = control_costs();
  const std::string document = read_whole_file(docs / "where-methods-fail.md");
  const std::string anew = with_cases(document, cases_as_markdown(cases, costs, "failures"));
  if (std::getenv("KERF_WRITE_DOCS") == nullptr) {
    EXPECT_EQ(document, anew) << "written anew by KERF_WRITE_DOCS=1";
    return;
  }
  std::filesystem::create_directories(docs / "failures");
  std::vector<Chart> charts;
  std::vector<std::string> names;
  for (const NamedCase& each : cases) {
    charts.push_back(each.picture);
    names.push_back(each.name);
  }
  charts.push_back(costs.picture);
  names.emplace_back("control_cost");
  const auto drawn = draw_all(charts);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    write_whole_file(docs / "failures" / (names[i] + ".svg"), drawn[i]);
  write_whole_file(docs / "where-methods-fail.md", anew);
}

TEST(Document, IsRefusedWithoutAPlaceForTheCases) {
  EXPECT_THROW((void)with_cases("# Where methods fail\n", "text"), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
