#include "poses/turns.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d axis = Vector3d(1.0, 2.0, -2.0) / 3.0;

TEST(RotationPath, GoesOnPastWholeTurnsAndBack) {
  RotationPath path;
  for (int i = 0; i <= 400; ++i) {
    const double angle = 15.0 * std::sin(std::numbers::pi * i / 400.0);
    const Quaterniond turn(AngleAxisd(angle, axis));
    const Vector3d r = path.next(i % 2 == 0 ? turn : Quaterniond(-turn.coeffs()));
    ASSERT_NEAR((r - angle * axis).norm(), 0.0, 1e-12) << i;
  }
}

TEST(RotationPath, BeginsWithTheShortestVector) {
  RotationPath path;
  EXPECT_NEAR((path.next(Quaterniond(AngleAxisd(3.5, axis))) + (2.0 * std::numbers::pi - 3.5) * axis).norm(),
              0.0, 1e-14);
  EXPECT_NEAR(RotationPath().next(Quaterniond(0.0, 0.0, 0.0, 1.0)).norm(), std::numbers::pi, 1e-15);
}

TEST(RotationPath, HoldsAWholeTurnThatIsReachedExactly) {
  RotationPath path;
  for (const double angle : {0.0, 2.0, 4.0, 6.0}) (void)path.next(Quaterniond(AngleAxisd(angle, axis)));
  EXPECT_NEAR((path.next(Quaterniond::Identity()) - 2.0 * std::numbers::pi * axis).norm(), 0.0, 1e-12);
}

TEST(RotationPath, GoesOnAfterARowWithoutARotation) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  RotationPath path;
  for (const double angle : {1.0, 2.0, 3.0}) (void)path.next(Quaterniond(AngleAxisd(angle, axis)));
  EXPECT_TRUE(path.next(Quaterniond(nan, nan, nan, nan)).hasNaN());
  EXPECT_NEAR(path.next(Quaterniond(AngleAxisd(4.0, axis))).norm(), 4.0, 1e-12);
}

TEST(Turn, OfACoarselyWrittenMatrixIsTheNearestRotation) {
  const Eigen::Matrix3d exact = AngleAxisd(2.0, axis).toRotationMatrix();
  std::array<double, 9> rows{};
  for (int i = 0; i < 9; ++i)
    rows.at(static_cast<std::size_t>(i)) = std::round(1e4 * exact(i / 3, i % 3)) / 1e4;
  const OrientationForm form{.kind = OrientationForm::Kind::matrix, .order = "rows"};
  EXPECT_EQ(fault_of(form, rows), "");
  const Quaterniond turn = turn_of(form, rows);
  EXPECT_NEAR(turn.norm(), 1.0, 1e-15);
  EXPECT_LT(turn.angularDistance(Quaterniond(AngleAxisd(2.0, axis))), 1e-4);
}

}  // namespace
}  // namespace kerf::bench
