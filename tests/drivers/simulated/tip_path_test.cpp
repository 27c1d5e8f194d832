#include "kerf/drivers/tip_path.h"

#include <gtest/gtest.h>

#include "kerf/drivers/device.h"

namespace kerf::drivers {
namespace {

using Eigen::Vector3d;

TEST(TipPath, RestsAtEachWaypointAndGoesStraightToTheNext) {
  const TipPath path(
      {.waypoints_m = {{0.0, 0.0, 0.0}, {0.02, -0.04, 0.0}}, .stroke_s = 0.5, .pause_s = 0.25});
  EXPECT_EQ(path.at(0.2).position_m, Vector3d::Zero());
  EXPECT_EQ(path.at(0.2).speed_m_s, Vector3d::Zero());
  EXPECT_LT((path.at(0.5).position_m - Vector3d(0.01, -0.02, 0.0)).norm(), 1e-15) << "half of the stroke";
  EXPECT_LT((path.at(0.5).speed_m_s - 1.875 / 0.5 * Vector3d(0.02, -0.04, 0.0)).norm(), 1e-14);
  EXPECT_LT((path.at(0.9).position_m - Vector3d(0.02, -0.04, 0.0)).norm(), 1e-15);
  EXPECT_LT(path.at(1.5).position_m.norm(), 1e-15) << "and back to the first";
}

TEST(TipPath, StaysAtItsOnlyWaypoint) {
  const TipPath path({.waypoints_m = {{0.01, 0.02, 0.03}}});
  for (const double time_s : {0.0, 0.5, 3.3}) {
    EXPECT_EQ(path.at(time_s).position_m, Vector3d(0.01, 0.02, 0.03));
    EXPECT_EQ(path.at(time_s).speed_m_s, Vector3d::Zero());
  }
}

TEST(TipPath, ReadsWaypointsInMillimetresAndMetres) {
  const auto waypoints = parse_waypoints("0:0:0mm,30:-20:1.5mm,-0.01:0:0m");
  ASSERT_EQ(waypoints.size(), 3U);
  EXPECT_LT((waypoints[1] - Vector3d(0.03, -0.02, 0.0015)).norm(), 1e-17);
  EXPECT_EQ(waypoints[2], Vector3d(-0.01, 0.0, 0.0));
}

TEST(TipPath, RefusesATextThatIsNoPath) {
  for (const char* text :
       {"", "0:0mm", "0:0:0", "0:0:0cm", "0:0:0:0mm", "0:0:0mm,", "0,0,0mm", "nan:0:0m", "a:b:cm"}) {
    EXPECT_THROW((void)parse_waypoints(text), DeviceError) << text;
  }
}

TEST(TipPath, DrawsTheSameWaypointsFromOneSeed) {
  const auto drawn = drawn_waypoints(3, 0.04);
  EXPECT_EQ(drawn, drawn_waypoints(3, 0.04));
  EXPECT_NE(drawn, drawn_waypoints(4, 0.04));
  EXPECT_EQ(drawn.front(), Vector3d::Zero());
  double furthest = 0.0;
  for (const Vector3d& place : drawn) furthest = std::max(furthest, place.cwiseAbs().maxCoeff());
  EXPECT_LE(furthest, 0.04);
  EXPECT_GT(furthest, 0.03);
}

}  // namespace
}  // namespace kerf::drivers
