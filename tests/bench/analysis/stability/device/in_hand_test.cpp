#include "stability/device/in_hand.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

LawFile spring_between_the_blades(double stiffness_n_per_rad) {
  const double values[] = {stiffness_n_per_rad, 1e-9, 1e-9};
  return {.law = models::Law::make("kelvin", values),
          .contact = {.position = 0.5, .direction = -1.0},
          .axis = "theta",
          .position_unit = "rad"};
}

TEST(InHand, ATissueThatIsTooStiffForTheDeviceHumsAndSaysHow) {
  const drivers::DeviceInfo scissors = drivers::open_device("sim:scissors")->info();
  EXPECT_EQ(limit_cycle_in_hand(spring_between_the_blades(5.0), scissors, 1000.0, light_grip, 0.3),
            std::nullopt);
  const auto limit_cycle =
      limit_cycle_in_hand(spring_between_the_blades(1e5), scissors, 1000.0, firm_grip, 0.01);
  ASSERT_TRUE(limit_cycle);
  EXPECT_NE(limit_cycle->find("rms"), std::string::npos);
}

TEST(InHand, WhatNobodyKnowsOrPressesIsNotJudged) {
  const drivers::DeviceInfo premium = drivers::open_device("sim:premium")->info();
  LawFile law = spring_between_the_blades(1e5);
  law.axis = "q1";
  law.force_unit = "N·m";
  EXPECT_EQ(limit_cycle_in_hand(law, premium, 1000.0, firm_grip, 0.01), std::nullopt);
  const drivers::DeviceInfo scissors = drivers::open_device("sim:scissors")->info();
  EXPECT_EQ(limit_cycle_in_hand(spring_between_the_blades(1e5), scissors, 1000.0, firm_grip, 0.0),
            std::nullopt);
}

TEST(InHand, GripsHaveNames) {
  EXPECT_EQ(grip_named("firm").stiffness_n_per_m, 600.0);
  EXPECT_EQ(grip_named("none").mass_kg, 0.0);
  EXPECT_THROW((void)grip_named("iron"), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
