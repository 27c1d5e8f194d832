#include "stability/device/in_hand.h"

#include <stdexcept>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/example_laws.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

LawFile spring_between_the_blades(double stiffness_n_per_rad) {
  const double values[] = {stiffness_n_per_rad, 1e-9, 1e-9};
  return {.law = models::Law::make("kelvin", values),
          .contact = {.position = 0.5, .direction = -1.0},
          .axis = "theta",
          .position_unit = "rad"};
}

TEST(InHand, ATissueThatIsTooStiffForTheDeviceHumsAndSaysHow) {
  const drivers::DeviceInfo scissors = drivers::open_device("sim:scissors")->info();
  const StabilityVerdict soft =
      stability_in_hand(spring_between_the_blades(5.0), scissors, 1000.0, light_grip, 0.3);
  EXPECT_EQ(soft.stable, Stable::yes);
  EXPECT_EQ(soft.why, "");
  const StabilityVerdict stiff =
      stability_in_hand(spring_between_the_blades(1e5), scissors, 1000.0, firm_grip, 0.01);
  EXPECT_EQ(stiff.stable, Stable::no);
  EXPECT_THAT(stiff.why, HasSubstr("N rms"));
}

TEST(InHand, WhatNobodyKnowsOrPressesIsNotJudgedAndSaysWhy) {
  const drivers::DeviceInfo premium = drivers::open_device("sim:premium")->info();
  LawFile law = spring_between_the_blades(1e5);
  law.axis = "q1";
  law.force_unit = "N·m";
  const auto why = [](const LawFile& judged, const drivers::DeviceInfo& device, double deepest) {
    return why_not_judged(stability_in_hand(judged, device, 1000.0, firm_grip, deepest));
  };
  EXPECT_THAT(why(law, premium, 0.01), HasSubstr("axis 'q1' of"));
  EXPECT_THAT(why(law, premium, 0.01), HasSubstr("has no known mass and friction"));
  drivers::DeviceInfo scissors = drivers::open_device("sim:scissors")->info();
  EXPECT_THAT(why(spring_between_the_blades(1e5), scissors, 0.0), HasSubstr("how deep a hand presses"));
  const LawFile blade{.law = test::example("blade")};
  EXPECT_THAT(why(blade, drivers::open_device("sim:pose6")->info(), 0.01), HasSubstr("several axes"));
  scissors.axes[0].mechanics.reset();  // as of every real device
  EXPECT_THAT(why(spring_between_the_blades(1e5), scissors, 0.01), HasSubstr("no known mass and friction"));
}

TEST(StabilityVerdict, IsTrueFalseOrNullInFiles) {
  for (const auto& [stable, text] :
       {std::pair{Stable::yes, "true"}, {Stable::no, "false"}, {Stable::not_judged, "null"}}) {
    EXPECT_EQ(to_json(stable).dump(), text);
    EXPECT_EQ(stable_from(to_json(stable)), stable);
  }
  EXPECT_EQ(StabilityVerdict{}.stable, Stable::not_judged) << "until somebody has judged it";
  EXPECT_EQ(why_not_judged(not_stable("it hums")), "");
}

TEST(InHand, GripsHaveNames) {
  EXPECT_EQ(grip_named("firm").stiffness_n_per_m, 600.0);
  EXPECT_EQ(grip_named("none").mass_kg, 0.0);
  EXPECT_THROW((void)grip_named("iron"), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
