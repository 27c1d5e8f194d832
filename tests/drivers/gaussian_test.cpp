#include "kerf/drivers/gaussian.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

TEST(Gaussian, HasTheMomentsOfTheStandardNormalDistribution) {
  constexpr int draws = 200'000;
  Gaussian random(7);
  double mean = 0.0;
  double square = 0.0;
  double fourth = 0.0;
  for (int i = 0; i < draws; ++i) {
    const double value = random();
    ASSERT_TRUE(std::isfinite(value));
    mean += value / draws;
    square += value * value / draws;
    fourth += std::pow(value, 4) / draws;
  }
  // Four standard errors: 1, sqrt(2) and sqrt(96) over sqrt(draws).
  EXPECT_NEAR(mean, 0.0, 4.0 / std::sqrt(draws));
  EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / draws));
  EXPECT_NEAR(fourth, 3.0, 4.0 * std::sqrt(96.0 / draws));
}

TEST(Gaussian, IsTheSameForOneSeedAndAnotherForAnother) {
  Gaussian one(3);
  Gaussian same(3);
  Gaussian other(4);
  const double first = one();
  EXPECT_EQ(first, same());
  EXPECT_NE(first, other());
}

}  // namespace
}  // namespace kerf::drivers
