#include "choose/loop_checks.h"

#include <array>
#include <atomic>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "known_cuts.h"
#include "known_laws.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

const std::atomic<bool> go_on{false};
const models::Contact at_30_degrees{.position = 0.52, .direction = -1.0};

/// A Kelvin law between the blades of the simulated scissors.
LawFile kelvin(double stiffness_n_per_rad) {
  const std::array values{stiffness_n_per_rad, stiffness_n_per_rad, 0.2 * stiffness_n_per_rad};
  return {.law = models::Law::make("kelvin", values),
          .contact = at_30_degrees,
          .axis = "theta",
          .position_unit = "rad",
          .force_unit = "N"};
}

/// Where scissors that close were recorded, up to a depth.
schema::Recording recorded(double contact, double depth) {
  schema::Recording recording = test::cut_of(test::known_kelvin(), {.seconds = 2.0, .depth = depth / 1.2});
  for (double& position : recording.position) position = contact - position;
  return recording;
}

LoopChecks checks_on(const std::string& uri, double deepest, LoopCheckOptions options = {}) {
  options.device_uri = uri;
  LoopChecks checks(std::move(options), go_on);
  checks.place(recorded(at_30_degrees.position, deepest), 0, at_30_degrees);
  return checks;
}

TEST(DeviceFor, IsTheSimulatedOneOrTheFirstWithSuchAnAxis) {
  schema::Recording recording = recorded(0.5, 0.3);
  EXPECT_EQ(device_for(recording, 0), "sim:scissors");
  recording.header.device_uri = "sim:scissors?seed=4";
  EXPECT_EQ(device_for(recording, 0), "sim:scissors?seed=4");
  recording.header.device_uri = "falcon:0";
  recording.axes[0].position_unit = "m";
  EXPECT_EQ(device_for(recording, 0), "sim:scissors") << "whose x_s is a length";
  recording.axes[0].force_unit = "K";
  EXPECT_THROW((void)device_for(recording, 0), std::invalid_argument);
}

TEST(LoopChecks, FindASoftTissueStable) {
  const LoopChecks checks = checks_on("sim:scissors?noise=off", 0.4);
  EXPECT_EQ(checks.stability(kelvin(5.0)).stable, Stable::yes);
  EXPECT_EQ(checks.placed_in_words(), "");
}

TEST(LoopChecks, FindAWallThatIsTooStiffUnstable) {
  const LoopChecks checks = checks_on("sim:scissors?noise=off", 0.02);
  const StabilityVerdict verdict = checks.stability(kelvin(3e4));
  EXPECT_EQ(verdict.stable, Stable::no);
  EXPECT_THAT(verdict.why, HasSubstr("on sim:scissors"));
}

TEST(LoopChecks, JudgeALawUnderThePassivityControllerAsItIsThere) {
  LoopChecks checks(
      {.device_uri = "sim:axis?noise=off&viscous=0.5Ns/m&limit=40N&slew=100000N/s", .grip = "light"}, go_on);
  schema::Recording recording = test::cut_of(test::known_kelvin(), {.seconds = 2.0, .depth = 1e-3});
  recording.axes[0].name = "x";
  recording.axes[0].position_unit = "m";
  const models::Contact at_rest{.position = 0.0, .direction = 1.0};
  checks.place(recording, 0, at_rest);
  const auto wall = [&](double stiffness_n_per_m) {
    return LawFile{.law = models::Law::make("kelvin", std::array{stiffness_n_per_m, 1e-9, 1e-9}),
                   .contact = at_rest,
                   .axis = "x",
                   .position_unit = "m",
                   .force_unit = "N"};
  };
  const ControlledInHand soft = checks.controlled(wall(300.0));
  EXPECT_EQ(soft.verdict.stable, Stable::yes);
  EXPECT_EQ(soft.added_n, 0.0) << "2 b / T = 1000 N/m: it never acts";
  EXPECT_GT(checks.controlled(wall(3000.0)).added_n, 0.0);
  // In a hand that damps well the wall alone holds more than one that is braked by late readings
  // (`kerf stability --controllers` says the same of this device).
  double stiffness = 500.0;
  while (checks.stability(wall(stiffness)).stable == Stable::yes) stiffness *= 1.2;
  const ControlledInHand found = checks.controlled(wall(stiffness));
  EXPECT_EQ(found.verdict.stable, Stable::no) << stiffness;
  EXPECT_THAT(found.verdict.why, HasSubstr("its force swings by"));
}

TEST(LoopChecks, FindALawThatGivesEnergyUnstable) {
  LawFile law = kelvin(5.0);
  law.law = models::Law::make("exponential", std::array{0.2, 0.5, -0.1}, {{"thickness", 0.1}});
  const StabilityVerdict verdict = checks_on("sim:scissors?noise=off", 0.4).stability(law);
  EXPECT_EQ(verdict.stable, Stable::no);
  EXPECT_THAT(verdict.why, HasSubstr("gives energy to the hand again and again"));
}

TEST(LoopChecks, DoNotJudgeALawOnADeviceOfWhichNobodyKnowsMassAndFriction) {
  LoopChecks checks({.device_uri = "sim:premium"}, go_on);
  schema::Recording recording = recorded(0.1, 0.1);
  recording.axes[0].name = "q1";
  recording.axes[0].force_unit = "N·m";
  LawFile law = kelvin(0.01);
  law.axis = "q1";
  law.force_unit = "N·m";
  law.contact = {.position = 0.1, .direction = -1.0};
  checks.place(recording, 0, law.contact);
  const StabilityVerdict verdict = checks.stability(law);
  EXPECT_EQ(verdict.stable, Stable::not_judged);
  EXPECT_THAT(verdict.why, HasSubstr("on sim:premium, axis 'q1' of"));
  EXPECT_THAT(verdict.why, HasSubstr("has no known mass and friction"));
}

TEST(LoopChecks, PlaceALawWhereTheHandMeetsIt) {
  LoopChecks checks({.device_uri = "sim:scissors"}, go_on);
  const models::Contact far_away{.position = 2.0, .direction = -1.0};
  checks.place(recorded(2.0, 0.3), 0, far_away);
  EXPECT_THAT(checks.placed_in_words(), HasSubstr("of theta"));
}

TEST(LoopChecks, RefuseADeviceWithoutSuchAnAxis) {
  LoopChecks checks({.device_uri = "sim:premium"}, go_on);
  EXPECT_THROW(checks.place(recorded(0.5, 0.3), 0, at_30_degrees), std::invalid_argument);
  EXPECT_THROW(LoopChecks({.device_uri = "sim:spoon"}, go_on), drivers::DeviceError);
}

TEST(LoopChecks, SayWhatALawTookOfItsDeadlines) {
  const Deadline deadline = checks_on("sim:scissors", 0.4, {.seconds = 0.3}).deadline(kelvin(5.0));
  EXPECT_EQ(deadline.ticks, 300U);
  EXPECT_GT(deadline.p999_us, 0.0);
  EXPECT_TRUE(deadline.held || !deadline.why.empty());
}

TEST(LoopChecks, HoldALawToTheMarginThatIsAskedFor) {
  const Deadline deadline =
      checks_on("sim:scissors", 0.4, {.seconds = 0.3, .margin = 1e-6}).deadline(kelvin(5.0));
  EXPECT_FALSE(deadline.held);
  EXPECT_FALSE(deadline.why.empty());
}

}  // namespace
}  // namespace kerf::bench
