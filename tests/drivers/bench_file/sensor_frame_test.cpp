#include "kerf/drivers/sensor_frame.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

using testing::HasSubstr;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
/// The device's x is the sensor's y, its y the sensor's -x: a quarter turn about z.
constexpr std::array<SensorFrame::Vector, 3> quarter{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};

TEST(SensorFrame, LeavesAWrenchAsItIsWhereItSaysNothing) {
  const Axes wrench{1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  EXPECT_EQ(SensorFrame().apply(wrench), wrench);
}

// A force on the tip has no torque about it, whatever the sensor at the other end of the lever feels.
TEST(SensorFrame, TellsNoTorqueAboutTheTipOfAForceThatActsThere) {
  const SensorFrame frame{.rotation = quarter, .tool_m = {0.03, -0.02, 0.085}};
  // 10 N along z at the tip: r x f = (ry fz, -rx fz, 0).
  const Axes told = frame.apply({0.0, 0.0, 10.0, -0.2, -0.3, 0.0});
  EXPECT_EQ(told[2], 10.0);
  for (const std::size_t i : {0U, 1U, 3U, 4U, 5U}) EXPECT_NEAR(told[i], 0.0, 1e-15) << i;
}

TEST(SensorFrame, MovesTheTorqueByTheLeverAndTurnsBoth) {
  const SensorFrame frame{.rotation = quarter, .tool_m = {0.0, 0.0, 0.1}};
  // f = (1, 2, 3), r x f = (-0.2, 0.1, 0): t' before it is turned is (4.2, 4.9, 6).
  const Axes told = frame.apply({1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
  const Axes expected{2.0, -1.0, 3.0, 4.9, -4.2, 6.0};
  for (std::size_t i = 0; i < max_axes; ++i) EXPECT_NEAR(told[i], expected[i], 1e-15) << i;
}

TEST(SensorFrame, LeavesAGapAGap) {
  Axes gap{};
  gap.fill(unknown);
  for (const double one : SensorFrame{.rotation = quarter, .tool_m = {0.1, 0.1, 0.1}}.apply(gap))
    EXPECT_TRUE(std::isnan(one));
}

TEST(SensorFrame, LeavesOnlyThatUnknownWhichDependsOnWhatIs) {
  // A sensor of fz alone, turned about z, with a lever along z: fz needs nothing else.
  const SensorFrame frame{.rotation = quarter, .tool_m = {0.0, 0.0, 0.1}};
  const Axes told = frame.apply({unknown, unknown, 3.0, unknown, unknown, unknown});
  EXPECT_EQ(told[2], 3.0);
  EXPECT_TRUE(std::isnan(told[0]) && std::isnan(told[1]) && std::isnan(told[3]));
}

TEST(SensorFrame, KnowsWhatIsNoRotation) {
  EXPECT_EQ(no_rotation(quarter), "");
  EXPECT_EQ(no_rotation({{{0.7071, 0.7071, 0}, {-0.7071, 0.7071, 0}, {0, 0, 1}}}), "");
  EXPECT_THAT(no_rotation({{{1, 0, 0}, {0, 1.2, 0}, {0, 0, 1}}}), HasSubstr("row 2 has the length 1.2"));
  EXPECT_THAT(no_rotation({{{1, 0, 0}, {0.6, 0.8, 0}, {0, 0, 1}}}),
              HasSubstr("rows 1 and 2 are 53.13 degrees"));
  EXPECT_THAT(no_rotation({{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}), HasSubstr("it mirrors"));
  EXPECT_THAT(no_rotation({{{unknown, 0, 0}, {0, 1, 0}, {0, 0, 1}}}), HasSubstr("row 1"));
}

}  // namespace
}  // namespace kerf::drivers
