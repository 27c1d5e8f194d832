#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/law.h>
#include <kerf/models/scissors_analytic.h>

namespace kerf::models {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double lever = 0.28 / 7.58;
constexpr double contact = 0.5;

double force_at(const std::vector<double>& values, double theta, double velocity) {
  const auto law = ScissorsAnalytic<double>::make(values, {});
  ScissorsAnalytic<double>::State state;
  return law.step(state, {contact - theta, velocity}, 1e-3);
}

TEST(ScissorsAnalytic, IsTheSumOfItsThreePartsAtTheCheckValues) {
  // x_c at 10 degrees by the closed form.
  const double x_c = 23.1825114283e-3;
  const double theta = 10.0 * degree;
  EXPECT_NEAR(force_at({0.01, 0.0, 0.0}, theta, 1.0), 0.01 / lever, 1e-12);
  EXPECT_NEAR(force_at({0.0, 0.5, 0.0}, theta, 1.0) / (0.5 * x_c / lever), 1.0, 1e-10);
  EXPECT_NEAR(force_at({0.0, 0.0, 5.0}, theta, 1.0) / (5.0 * x_c / lever), 1.0, 1e-10);
  EXPECT_NEAR(force_at({0.01, 0.5, 5.0}, theta, 1.0), (0.01 + 5.5 * x_c) / lever, 1e-9);
}

TEST(ScissorsAnalytic, OpeningFeelsFrictionAloneTheOtherWay) {
  const double theta = 10.0 * degree;
  EXPECT_NEAR(force_at({0.01, 0.5, 5.0}, theta, -1.0), -force_at({0.01, 0.5, 0.0}, theta, 1.0), 1e-12);
}

TEST(ScissorsAnalytic, CutsOnlyInTheMaterial) {
  EXPECT_EQ(force_at({0.0, 0.0, 5.0}, contact + 0.01, 1.0), 0.0);
  EXPECT_GT(force_at({0.0, 0.0, 5.0}, contact - 0.01, 1.0), 0.0);
}

TEST(ScissorsAnalytic, IsZeroWhereTheBladesDoNotCut) {
  for (const double theta : {-0.1, 0.0, 3.27 * degree, 0.71, 2.0}) {
    EXPECT_EQ(force_at({0.01, 0.5, 5.0}, theta, 1.0), 0.0) << theta;
  }
  EXPECT_GT(force_at({0.01, 0.5, 5.0}, 3.28 * degree, 1.0), 0.0);
}

TEST(ScissorsAnalytic, RefusesATipThatIsTheWiderEnd) {
  EXPECT_THROW((void)Law::make("scissors_analytic", std::vector{0.0, 0.0, 1.0}, {{"tip_half_width", 5e-3}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace kerf::models
