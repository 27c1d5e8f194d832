#include "profiles/beside_zero.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::fitting {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

models::ParameterInfo linear(double lower, double upper) {
  return {.name = "p", .lower = lower, .upper = upper, .scale = models::Scale::linear, .meaning = ""};
}

/// Two parameters with a parabola for their sum of squares, one of them at zero with the limit `limit`; the
/// other's best goes along with `slope` of it.
std::vector<BestBeside> of_a_parabola(double slope, double limit) {
  std::vector<BestBeside> beside;
  for (const double share : {0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0})
    beside.push_back({.others = Eigen::VectorXd::Constant(1, slope * share * limit),
                      .left = std::sqrt(1.0 - share * share)});
  return beside;
}

// The ellipse of both, seen from the side: sqrt(half^2 + (slope limit)^2), on the side to which the other
// goes.
TEST(BesideZero, OfAParabolaIsTheShadowOfTheEllipse) {
  const Limits alone{.lower = -0.5, .upper = 0.5, .by = IntervalBy::wald};
  const auto info = linear(-10.0, 10.0);
  for (const double slope : {-0.2, -1.0, -4.0}) {
    const Widened wide = widened(alone, info, 0.0, of_a_parabola(slope, 1.5), 0);
    const double exact = std::hypot(0.5, 1.5 * slope);
    EXPECT_NEAR(wide.limits.lower, -exact, 0.02 * exact) << slope;
    EXPECT_EQ(wide.limits.upper, 0.5);
    EXPECT_NEAR(wide.growth, 0.5 + exact, 0.02 * exact);
    EXPECT_EQ(wide.limits.by, IntervalBy::profile);
  }
}

TEST(BesideZero, OfWhatDoesNotMoveIsAsItWas) {
  const Limits alone{.lower = -0.5, .upper = 0.5, .by = IntervalBy::wald};
  const Widened wide = widened(alone, linear(-10.0, 10.0), 0.0, of_a_parabola(0.0, 1.5), 0);
  EXPECT_EQ(wide.limits.lower, -0.5);
  EXPECT_EQ(wide.limits.upper, 0.5);
  EXPECT_EQ(wide.limits.by, IntervalBy::wald);
  EXPECT_EQ(wide.growth, 1.0);
}

TEST(BesideZero, HasNoLimitWhereItComesToTheEndOfTheRange) {
  const Limits alone{.lower = -0.5, .upper = 0.5, .by = IntervalBy::wald};
  EXPECT_EQ(widened(alone, linear(-10.0, 1.0), 0.0, of_a_parabola(1.0, 3.0), 0).limits.upper, infinite);
  const Limits open{.lower = -0.5, .upper = infinite, .by = IntervalBy::profile};
  const Widened wide = widened(open, linear(-10.0, 10.0), 0.0, of_a_parabola(1.0, 3.0), 0);
  EXPECT_EQ(wide.limits.upper, infinite);
  EXPECT_EQ(wide.limits.lower, -0.5);
}

TEST(BesideZero, HangsOnTheZeroWhatIsAnotherBesideIt) {
  const auto beside = of_a_parabola(1.0, 1.0);  // goes by 1, e-fold on a logarithmic scale
  EXPECT_TRUE(hangs_on(0.0, 0.01, 0.2, beside, 0));
  EXPECT_FALSE(hangs_on(0.0, 0.01, 0.05, beside, 0)) << "it is known with that one free as well";
  EXPECT_FALSE(hangs_on(0.0, 0.01, 0.2, of_a_parabola(0.1, 1.0), 0)) << "they share what they explain";
  EXPECT_TRUE(hangs_on(0.0, 0.01, infinite, {}, 0)) << "nobody knows how far that one may go";
}

}  // namespace
}  // namespace kerf::fitting
