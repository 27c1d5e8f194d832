#include "kerf/mechanisms/pantograph.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace kerf::mechanisms {
namespace {

using Vector = Pantograph::Vector;
constexpr double degree = std::numbers::pi / 180.0;

// At rest the arms of a 2DIY v3.1 lie at 168 and 12 degrees: mirrored about the middle between the motors,
// and the height by Pythagoras.
TEST(Pantograph, IsWhereItsForearmsMeet) {
  const Pantograph made({});
  const Vector rest = made.handle({168.0 * degree, 12.0 * degree});
  const double half = 0.019 + 0.07 * std::cos(12.0 * degree);
  EXPECT_NEAR(rest.x(), 0.019, 1e-12);
  EXPECT_NEAR(rest.y(), 0.07 * std::sin(12.0 * degree) + std::sqrt(0.09 * 0.09 - half * half), 1e-12);
  // Far apart they do not meet: 0.038 + 2 x 0.07 of 2 x 0.09 is in reach, with a wider base it is not.
  EXPECT_FALSE(Pantograph({.between_m = 0.1}).handle({180.0 * degree, 0.0}).allFinite());
}

TEST(Pantograph, FindsTheAnglesOfAPlaceAndBack) {
  for (const double between : {0.0, 0.02, 0.038}) {
    const Pantograph made({.between_m = between});
    for (double x = -0.03; x <= 0.07; x += 0.01) {
      for (double y = 0.05; y <= 0.13; y += 0.01) {
        const auto angles = made.angles_of({x, y});
        ASSERT_TRUE(angles) << x << ' ' << y;
        const Vector back = made.handle(*angles);
        EXPECT_NEAR(back.x(), x, 1e-12);
        EXPECT_NEAR(back.y(), y, 1e-12);
      }
    }
    EXPECT_FALSE(made.angles_of({0.0, 0.17}));
  }
}

TEST(Pantograph, HasTheJacobianOfItsMotion) {
  const Pantograph made({});
  constexpr double step = 1e-6;
  for (double y = 0.05; y <= 0.13; y += 0.02) {
    const Vector angles = *made.angles_of({0.03, y});
    const auto jacobian = made.jacobian(angles);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Vector by = step * Vector::Unit(i);
      const Vector difference = (made.handle(angles + by) - made.handle(angles - by)) / (2.0 * step);
      EXPECT_NEAR((jacobian.col(i) - difference).norm(), 0.0, 1e-8);
    }
  }
}

}  // namespace
}  // namespace kerf::mechanisms
