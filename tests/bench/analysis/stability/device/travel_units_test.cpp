#include "stability/device/travel_units.h"

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(TravelUnits, AreMetresAndNewtonsOfALengthAndOfAnAngleWithALever) {
  for (const drivers::AxisInfo& axis :
       {drivers::AxisInfo{.name = "x", .position_unit = "m", .force_unit = "N"},
        drivers::AxisInfo{.name = "theta", .position_unit = "rad", .force_unit = "N", .lever = 0.08}}) {
    const TravelUnits units(axis);
    EXPECT_EQ(units.stiffness(), "N/m");
    EXPECT_EQ(units.damping(), "N·s/m");
    EXPECT_EQ(units.mass(), "kg");
    EXPECT_EQ(units.depth().unit, "mm");
    EXPECT_EQ(units.energy().unit, "uJ");
  }
}

TEST(TravelUnits, AreThoseOfTheAngleWhereItHasNoLever) {
  const TravelUnits units(drivers::AxisInfo{.name = "q1", .position_unit = "rad", .force_unit = "N·m"});
  EXPECT_EQ(units.speed(), "rad/s");
  EXPECT_EQ(units.stiffness(), "N·m/rad");
  EXPECT_EQ(units.damping(), "N·m·s/rad");
  EXPECT_EQ(units.mass(), "kg·m²");
  EXPECT_EQ(units.depth().unit, "rad");
  EXPECT_EQ(units.depth().factor, 1.0);
  EXPECT_EQ(units.step().unit, "urad");
  EXPECT_EQ(units.energy().unit, "uJ");
}

TEST(TravelUnits, AreReadAsTheyWereWritten) {
  const TravelUnits units(drivers::AxisInfo{.name = "q1", .position_unit = "rad", .force_unit = "N·m"});
  EXPECT_EQ(TravelUnits(nlohmann::ordered_json{{"units", as_json(units)}}).stiffness(), "N·m/rad");
  EXPECT_EQ(TravelUnits(nlohmann::ordered_json{{"study", "law"}}).stiffness(), "N/m")
      << "of an earlier version";
}

}  // namespace
}  // namespace kerf::bench
