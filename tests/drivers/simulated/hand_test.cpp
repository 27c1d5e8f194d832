#include "kerf/drivers/hand.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

const HandOptions steady{
    .open_rad = 0.6, .close_rad = 0.1, .stroke_s = 0.8, .pause_s = 0.25, .variation = 0.0};

TEST(MinimumJerk, FollowsItsClosedForm) {
  for (const double s : {0.0, 0.1, 0.25, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(MinimumJerk::at(s).position, 10 * std::pow(s, 3) - 15 * std::pow(s, 4) + 6 * std::pow(s, 5),
                1e-14);
    EXPECT_NEAR(MinimumJerk::at(s).speed, 30 * std::pow(s, 2) - 60 * std::pow(s, 3) + 30 * std::pow(s, 4),
                1e-14);
  }
  EXPECT_EQ(MinimumJerk::at(0.5).speed, 1.875);
}

TEST(MinimumJerk, HoldsItsEnds) {
  EXPECT_EQ(MinimumJerk::at(-1.0).position, 0.0);
  EXPECT_EQ(MinimumJerk::at(2.0).position, 1.0);
  EXPECT_EQ(MinimumJerk::at(2.0).speed, 0.0);
}

TEST(Strokes, CloseAndOpenBetweenPauses) {
  Strokes strokes(steady);
  EXPECT_EQ(strokes.at(0.0).angle_rad, 0.6) << "the hand begins open";
  EXPECT_EQ(strokes.at(0.25).angle_rad, 0.6);
  EXPECT_NEAR(strokes.at(0.65).angle_rad, 0.35, 1e-12) << "half a stroke is half the way";
  EXPECT_NEAR(strokes.at(0.65).speed_rad_s, -1.875 * 0.5 / 0.8, 1e-12);
  EXPECT_NEAR(strokes.at(1.2).angle_rad, 0.1, 1e-12) << "paused while closed";
  EXPECT_EQ(strokes.at(1.2).speed_rad_s, 0.0);
  EXPECT_NEAR(strokes.at(2.2).angle_rad, 0.6, 1e-12) << "open again";
}

TEST(Strokes, VaryFromOneToTheNextWithTheirSeed) {
  const auto closed_angles = [](std::uint64_t seed) {
    HandOptions options = steady;
    options.variation = 0.05;
    options.seed = seed;
    Strokes strokes(options);
    std::vector<double> minima;
    double least = options.open_rad;
    for (int i = 0; i < 20'000; ++i) {
      const Strokes::Equilibrium now = strokes.at(1e-3 * i);
      least = std::min(least, now.angle_rad);
      if (now.angle_rad > 0.4 && least < 0.3) {
        minima.push_back(least);
        least = options.open_rad;
      }
    }
    return minima;
  };
  const auto angles = closed_angles(1);
  ASSERT_GE(angles.size(), 8U);
  EXPECT_NE(angles[0], angles[1]);
  EXPECT_EQ(angles, closed_angles(1));
  EXPECT_NE(angles, closed_angles(2));
  // The travel of 0.5 rad varies by 5 %, at most by two deviations, half of it at each end.
  for (const double angle : angles) EXPECT_NEAR(angle, 0.1, 0.5 * 2 * 0.05 * 0.5 + 1e-12);
}

}  // namespace
}  // namespace kerf::drivers
