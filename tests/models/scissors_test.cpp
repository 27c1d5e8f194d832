#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <kerf/models/scissors.h>

namespace kerf::models {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr ScissorsGeometry metzenbaum{};

TEST(ScissorsGeometry, MeetsTheCheckValues) {
  struct Check {
    double degrees, half_width_mm, cutting_point_mm;
  };
  for (const auto& check :
       {Check{5.0, 1.34990116341, 30.9472747084}, Check{10.0, 2.02048900229, 23.1825114283},
        Check{30.0, 3.03055541767, 11.7091669837}}) {
    const double theta = check.degrees * degree;
    EXPECT_NEAR(metzenbaum.half_width(theta) * 1e3 / check.half_width_mm, 1.0, 1e-10);
    ASSERT_TRUE(metzenbaum.cutting_point(theta).has_value());
    EXPECT_NEAR(*metzenbaum.cutting_point(theta) * 1e3 / check.cutting_point_mm, 1.0, 1e-10);
  }
  EXPECT_NEAR(metzenbaum.closing_angle() / degree / 3.27315408323, 1.0, 1e-10);
}

TEST(ScissorsGeometry, CutsAtTheTipWhenTheBladesHaveClosed) {
  const double tip_m = std::hypot(metzenbaum.blade_length_m, metzenbaum.tip_half_width_m);
  EXPECT_NEAR(*metzenbaum.cutting_point(metzenbaum.closing_angle()), tip_m, 1e-15);
}

TEST(ScissorsGeometry, HasNoCuttingPointWhereTheBladesDoNotCut) {
  for (const double theta : {-1.0, 0.0, 1e-300, 3.0 * degree, 0.71, std::numbers::pi, std::nan("")}) {
    EXPECT_FALSE(metzenbaum.cutting_point(theta).has_value()) << theta;
  }
}

}  // namespace
}  // namespace kerf::models
