#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <kerf/models/scissors.h>

namespace kerf::models {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr ScissorsGeometry metzenbaum{};
const CuttingPoint point(metzenbaum);

TEST(CuttingPoint, MeetsTheCheckValues) {
  struct Check {
    double degrees, half_width_mm, cutting_point_mm;
  };
  for (const auto& check :
       {Check{5.0, 1.34990116341, 30.9472747084}, Check{10.0, 2.02048900229, 23.1825114283},
        Check{30.0, 3.03055541767, 11.7091669837}}) {
    const double theta = check.degrees * degree;
    EXPECT_NEAR(point.half_width(theta) * 1e3 / check.half_width_mm, 1.0, 1e-10);
    ASSERT_TRUE(point.cuts_at(theta));
    EXPECT_NEAR(point(theta) * 1e3 / check.cutting_point_mm, 1.0, 1e-10);
  }
  EXPECT_NEAR(point.closing_angle() / degree / 3.27315408323, 1.0, 1e-10);
}

TEST(CuttingPoint, IsTheQuotientOfThePaperAtEveryAngle) {
  for (double theta = metzenbaum.closing_angle(); theta < 0.7; theta += 1e-3) {
    const double slope = std::tan(0.5 * theta);
    const double t = 4e-3 * slope / (slope + 3e-3 / 35e-3);
    EXPECT_NEAR(point(theta) / (t / std::sin(0.5 * theta)), 1.0, 1e-13);
  }
}

TEST(CuttingPoint, IsAtTheTipWhenTheBladesHaveClosed) {
  const double tip_m = std::hypot(metzenbaum.blade_length_m, metzenbaum.tip_half_width_m);
  EXPECT_NEAR(point(metzenbaum.closing_angle()), tip_m, 1e-15);
}

TEST(CuttingPoint, IsNowhereWhereTheBladesDoNotCut) {
  for (const double theta : {-1.0, 0.0, 1e-300, 3.0 * degree, 0.71, std::numbers::pi, std::nan("")}) {
    EXPECT_FALSE(point.cuts_at(theta)) << theta;
  }
}

TEST(CuttingPoint, TheGapVanishesThereAndGrowsTowardsTheTips) {
  const double theta = 20.0 * degree;
  EXPECT_NEAR(point.half_gap(theta, point(theta)), 0.0, 1e-18);
  EXPECT_GT(point.half_gap(theta, point(theta) + 1e-3), 0.0);
  EXPECT_LT(point.half_gap(theta, point(theta) - 1e-3), 0.0);
}

}  // namespace
}  // namespace kerf::models
