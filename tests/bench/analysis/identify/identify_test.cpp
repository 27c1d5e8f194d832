#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "identify/axis_experiment.h"
#include "identify/identified_device.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

AxisExperiment excited(const std::string& uri, double force_n = 2.0, bool held = false) {
  const std::atomic<bool> stop{false};
  return excite_axis({.device_uri = uri,
                      .force_n = force_n,
                      .travel_m = 0.02,
                      .seconds = 10.0,
                      .held = held,
                      .places = 1,
                      .virtual_time = true},
                     0, {}, stop);
}

constexpr const char* free_axis =
    "sim:axis?hand=off&mass=0.12kg&viscous=0.6Ns/m&coulomb=0.15N&gravity=-0.08N&delay=1.63ms&step=0.01mm&"
    "tells=off&sensor=off";

template <typename Interval>
void expect_holds(const std::optional<Interval>& number, double truth) {
  ASSERT_TRUE(number);
  // Of so many intervals of 95 % one may miss its truth: half as wide again does not.
  const double half = 0.5 * (number->upper - number->lower);
  EXPECT_NEAR(number->value, truth, 1.5 * half);
  EXPECT_LT(half, 0.1 * truth);
}

TEST(IdentifiedDevice, HasTheTruthOfASimulatedAxisInItsFile) {
  IdentifiedDevice device;
  AxisExperiment measured = excited(free_axis);
  EXPECT_EQ(measured.problem, "");
  device.device = measured.device;
  device.axes.push_back(identified_axis(std::move(measured), 0));
  EXPECT_TRUE(device.is_good());
  const drivers::DeviceModel model =
      drivers::parse_device_model(drivers::to_toml(model_of(device)), "a test");
  const drivers::AxisModel& axis = model.axes.front();
  expect_holds(axis.mass, 0.12);
  expect_holds(axis.viscous, 0.6);
  expect_holds(axis.coulomb_up, 0.15);
  expect_holds(axis.delay, 1.63e-3);
  EXPECT_NEAR(axis.gravity->value, -0.08, 0.01);
  EXPECT_NEAR(axis.encoder_step->value, 1e-5, 1e-10);
  EXPECT_EQ(axis.validation.fits, true);
  EXPECT_FALSE(axis.motor_constant) << "nothing measures a force";
}

TEST(IdentifiedDevice, HasTheTruthByPeriodsOfAQuarterOfASecondAndBothDomainsAgree) {
  const std::atomic<bool> stop{false};
  const AxisExperiment measured = excite_axis({.device_uri = free_axis,
                                               .force_n = 2.0,
                                               .travel_m = 0.02,
                                               .seconds = 10.0,
                                               .period_s = 0.25,
                                               .places = 1,
                                               .lowest_hz = 5.0,
                                               .highest_hz = 60.0,
                                               .virtual_time = true},
                                              0, {}, stop);
  const IdentifiedAxis axis = identified_axis(measured, 0);
  ASSERT_EQ(axis.problem, "");
  expect_holds(axis.found->mass_kg, 0.12);
  expect_holds(axis.found->coulomb_n, 0.15);
  expect_holds(axis.found->delay_s, 1.63e-3);
  EXPECT_EQ(axis.found->fits, true);
  for (const identification::Agreement& one : axis.found->agreements) EXPECT_TRUE(one.agrees) << one.name;
}

TEST(IdentifiedDevice, HasNothingFromTheFrequencyDomainOfOneStretchWhichTellsNoSpread) {
  AxisExperiment measured = excited(free_axis);
  measured.experiment.stretches.resize(1);
  const identification::Identified found = identification::identify(measured.experiment);
  EXPECT_NEAR(found.mass_kg->value, 0.12, 1e-3);
  EXPECT_TRUE(std::isnan(found.frequency.model.axis.mass_kg));
  EXPECT_TRUE(std::isnan(found.frequency.model.axis.delay_s));
  EXPECT_TRUE(found.agreements.empty()) << "nothing was found there, and nothing disagrees";
}

TEST(IdentifiedDevice, LeavesGravityUnknownWhereItIsNotTold) {
  IdentifiedDevice device;
  device.offset = OffsetIs::unknown;
  AxisExperiment measured = excited(free_axis);
  device.device = measured.device;
  device.axes.push_back(identified_axis(std::move(measured), 0));
  const drivers::DeviceModel model = model_of(device);
  EXPECT_FALSE(model.axes.front().gravity);
  EXPECT_LT(model.axes.front().coulomb_up->lower, 0.15 - 0.07);
}

/// A simulated axis identified, in the hand or free.
identification::Identified found_of(const std::string& uri, bool held = false) {
  const IdentifiedAxis axis = identified_axis(excited(uri, 2.0, held), 0);
  EXPECT_EQ(axis.problem, "");
  return *axis.found;
}

constexpr const char* free_of_what_is_not_in_the_model =
    "sim:axis?hand=off&mass=0.16kg&viscous=0.5Ns/"
    "m&coulomb=0.05N&delay=1.4ms&step=0.005mm&tells=off&sensor=off";

TEST(IdentifiedDevice, NamesPlayBehindTheMotorAsBacklash) {
  const auto found = found_of(std::string(free_of_what_is_not_in_the_model) + "&backlash=0.25mm");
  EXPECT_EQ(found.fits, false);
  ASSERT_FALSE(found.explanations.empty());
  EXPECT_EQ(found.missing, identification::Missing::backlash);
  EXPECT_NE(found.why_not.back().find("backlash"), std::string::npos) << found.why_not.back();
}

TEST(IdentifiedDevice, NamesPlayInTheHandAsBacklashThoughALinkExplainsThreeQuarters) {
  const auto found = found_of(
      "sim:axis?sensor=off&tells=off&seed=5091&mass=0.272kg&viscous=0.98Ns/m&coulomb=0.121N&gravity=0.18N&"
      "delay=1.84ms&step=0.01mm&hand_mass=0.187kg&hand_damping=6Ns/m&grip=419N/m&backlash=0.33mm",
      true);
  EXPECT_EQ(found.fits, false);
  EXPECT_EQ(found.missing, identification::Missing::backlash);
}

TEST(IdentifiedDevice, NamesALinkThatYieldsAsOneWithItsStiffness) {
  const auto found = found_of(std::string(free_of_what_is_not_in_the_model) + "&flexible=2000N/m");
  EXPECT_EQ(found.fits, false);
  ASSERT_FALSE(found.explanations.empty());
  EXPECT_EQ(found.missing, identification::Missing::flexible_link);
  // Half of the mass behind it is what is taken for granted, and what it is.
  EXPECT_NEAR(1.0 / found.explanations.front().size, 2000.0, 400.0);
}

TEST(IdentifiedDevice, NamesCoggingThatSetsTheMotionOffOtherwiseEachPeriod) {
  const auto found =
      found_of(std::string(free_of_what_is_not_in_the_model) + "&cogging=0.18N&cogging_period=2.6mm");
  EXPECT_EQ(found.fits, false);
  ASSERT_FALSE(found.explanations.empty());
  EXPECT_EQ(found.missing, identification::Missing::cogging);
  EXPECT_NEAR(found.explanations.front().period_m, 2.6e-3, 0.1e-3);
}

TEST(IdentifiedDevice, HasTheMotorConstantOfAHeldAxisWithASensor) {
  const auto found = found_of(
      "sim:axis?mass=0.1kg&coulomb=0.08N&delay=1.2ms&step=0.01mm&tells=off&motor_constant=0.85", true);
  ASSERT_TRUE(found.motor_constant);
  const double half = 0.5 * (found.motor_constant->upper - found.motor_constant->lower);
  EXPECT_NEAR(found.motor_constant->value, 0.85, 1.5 * half);
  EXPECT_LT(half, 0.02);
}

TEST(IdentifiedDevice, HasNoGravityThatPushesItAwayBeforeItIsKnown) {
  // Eleven times its friction, and more than the pilot's spring holds within the travel.
  const auto found = found_of(
      "sim:axis?hand=off&mass=0.137kg&viscous=0.53Ns/m&coulomb=0.023N&gravity=0.26N&delay=1.2ms&step=0.002mm&"
      "tells=off&sensor=off");
  EXPECT_NEAR(found.offset_n.front().value, 0.26, 0.003);
}

TEST(IdentifiedDevice, HasGravityAtEachPlaceOfADeviceWhoseGravityIsALine) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "line.device.toml", R"(format = 1
date = "2026-01-31T12:00:00Z"
rate_hz = 1000
held = false
[device]
uri = "sim:axis"
model = "sim:axis"
[[axis]]
name = "x"
position_unit = "m"
force_unit = "N"
limits = { lower = -0.1, upper = 0.1, force = 10, slew = 5000, speed = 5, acceleration = 2000 }
mass = { value = 0.12, lower = 0.12, upper = 0.12, unit = "kg" }
viscous = { value = 0.6, lower = 0.6, upper = 0.6, unit = "N·s/m" }
coulomb_up = { value = 0.1, lower = 0.1, upper = 0.1, unit = "N" }
coulomb_down = { value = 0.1, lower = 0.1, upper = 0.1, unit = "N" }
delay = { value = 0.0015, lower = 0.0015, upper = 0.0015, unit = "s" }
encoder_step = { value = 1e-5, lower = 1e-5, upper = 1e-5, unit = "m" }
gravity_table = { position = [-0.06, 0.06], force = [0.2, -0.2] }
)");
  const std::atomic<bool> stop{false};
  IdentifiedDevice device;
  AxisExperiment measured = excite_axis(
      {.device_uri = "sim:axis?hand=off&tells=off&sensor=off&model=" + (folder / "line.device.toml").string(),
       .force_n = 2.0,
       .travel_m = 0.02,
       .seconds = 10.0,
       .places = 3,
       .virtual_time = true},
      0, {}, stop);
  device.device = measured.device;
  device.axes.push_back(identified_axis(std::move(measured), 0));
  ASSERT_TRUE(device.is_good());
  const identification::Identified& found = *device.axes.front().found;
  ASSERT_EQ(found.offset_n.size(), 3U);
  // 0.4 N over 0.12 m: within a place a spring, from place to place a constant force.
  EXPECT_NEAR(found.stiffness_n_per_m->value, 10.0 / 3.0, 0.05);
  const auto& places = device.axes.front().measured.places_m;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.offset_n[i].value, -10.0 / 3.0 * places[i], 0.001) << places[i];
  }
  const auto model = model_of(device).axes.front();
  ASSERT_TRUE(model.gravity_table);
  EXPECT_NEAR(model.gravity_table->at(0.02), -0.2 / 3.0, 0.001);
}

TEST(IdentifiedDevice, HasTheSameNumbersFromItsRecordings) {
  const test::TemporaryFolder folder;
  const std::atomic<bool> stop{false};
  AxisExperiment measured = excite_axis({.device_uri = free_axis,
                                         .force_n = 2.0,
                                         .travel_m = 0.02,
                                         .seconds = 10.0,
                                         .places = 1,
                                         .kind = identification::ExcitationKind::chirp,
                                         .virtual_time = true},
                                        0, folder / "x.h5", stop);
  const auto layout = layout_as_json(measured);
  IdentifiedDevice live;
  live.device = measured.device;
  live.axes.push_back(identified_axis(std::move(measured), 0));
  expect_holds(model_of(live).axes.front().mass, 0.12);
  IdentifiedDevice again;
  again.device = live.device;
  again.axes.push_back(identified_axis(read_experiment(folder / "x.h5", layout, 0), 0));
  auto expected = identified_as_json(live);
  auto found = identified_as_json(again);
  EXPECT_TRUE(found.at("axes").at(0).at("promised").is_null()) << "the design was not read";
  for (auto* const of : {&expected, &found}) of->at("axes").at(0).erase("promised");
  EXPECT_EQ(found, expected);
}

TEST(Excitation, KeepsWhatWasMeasuredWhenACableSlips) {
  const AxisExperiment measured = excited(std::string(free_axis) + "&fault=jump@5.0:5mm");
  EXPECT_EQ(measured.end, ExperimentEnd::fault);
  EXPECT_NE(measured.problem.find("moved farther than the device can"), std::string::npos)
      << measured.problem;
  EXPECT_FALSE(measured.experiment.stretches.empty());
}

// A hand that sways by three times of what the axis may travel, faster than the spring of the experiment
// holds it.
TEST(Excitation, LetsGoWhereAHandPushesItAway) {
  const AxisExperiment measured = excited(
      "sim:axis?mass=0.12kg&viscous=0.6Ns/"
      "m&coulomb=0.15N&delay=1.63ms&step=0.01mm&sway=0.06m&range=0.2m&tells=off",
      2.0, true);
  EXPECT_EQ(measured.end, ExperimentEnd::too_far) << measured.problem;
  EXPECT_NE(measured.problem, "");
  const IdentifiedAxis axis = identified_axis(measured, 0);
  EXPECT_NE(axis.problem, "") << "and nothing is told of what was not measured";
}

TEST(Excitation, SaysThatNothingMovesAnAxisWithoutAMotor) {
  const AxisExperiment measured = excited(std::string(free_axis) + "&motor=off");
  EXPECT_NE(measured.problem.find("no motor"), std::string::npos) << measured.problem;
}

TEST(Excitation, EndsWhereAMotorPullsTheOtherWay) {
  const AxisExperiment measured = excited(std::string(free_axis) + "&sign=-1");
  const IdentifiedAxis axis = identified_axis(measured, 0);
  EXPECT_NE(axis.problem, "");
}

TEST(Excitation, SaysThatAnExcitationIsTooWeakAndWhatWouldBeNeeded) {
  const AxisExperiment measured = excited(free_axis, 0.05);
  EXPECT_NE(measured.problem.find("--max-force"), std::string::npos) << measured.problem;
}

TEST(Excitation, RefusesAnAxisThatMayHaveNoForce) {
  EXPECT_THROW((void)excited(std::string(free_axis) + "&limit=0N"), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
