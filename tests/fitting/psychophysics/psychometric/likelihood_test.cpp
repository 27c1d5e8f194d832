#include "psychometric/likelihood.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace kerf::psychophysics {
namespace {

Problem answers(Shape shape, double most_dispersion) {
  return {.shape = shape,
          .guess = 0.5,
          .criterion = 0.75,
          .cells = {{0.1, {7, 10}}, {0.4, {15, 20}}, {0.8, {18, 20}}, {1.0, {12, 12}}},
          .lower = {-1.0, -2.0, 0.0, 0.0},
          .upper = {2.0, 4.0, 0.1, most_dispersion}};
}

constexpr Point somewhere{0.35, 0.9, 0.03, 0.2};

double slope_of(const std::function<double(double)>& f, double x) {
  constexpr double h = 1e-5;
  return (f(x + h) - f(x - h)) / (2.0 * h);
}

Point moved(std::size_t parameter, double to) {
  Point point = somewhere;
  point[parameter] = to;
  return point;
}

/// log of the beta function.
double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

TEST(Likelihood, GradientIsThatOfItsDifferences) {
  for (const Shape shape : {Shape::weibull, Shape::logistic, Shape::gaussian}) {
    for (const double most_dispersion : {0.0, 5.0}) {
      const Problem problem = answers(shape, most_dispersion);
      const Score here = score(problem, somewhere);
      EXPECT_DOUBLE_EQ(here.log_likelihood, log_likelihood(problem, somewhere));
      for (std::size_t i = 0; i < parameters; ++i) {
        const double slope =
            slope_of([&](double value) { return log_likelihood(problem, moved(i, value)); }, somewhere[i]);
        EXPECT_NEAR(here.gradient[i], slope, 1e-6 * (1.0 + std::abs(slope))) << i << ", " << most_dispersion;
      }
    }
  }
}

TEST(Likelihood, KnowsItsCurvatureAlongTheDispersion) {
  Problem problem = answers(Shape::weibull, 5.0);
  problem.cells = {{0.1, {2, 20}}, {0.4, {20, 20}}, {0.8, {8, 20}}, {1.0, {20, 20}}};  // far apart
  const double bend =
      slope_of([&](double value) { return score(problem, moved(dispersion_index, value)).gradient[3]; },
               somewhere[dispersion_index]);
  ASSERT_LT(bend, 0.0);
  const Score here = score(problem, somewhere);
  ASSERT_GT(-bend, 0.1 * std::abs(here.gradient[dispersion_index]));
  EXPECT_NEAR(here.information[dispersion_index][dispersion_index], -bend, 1e-6 * -bend);
}

TEST(Likelihood, IsMaximisedWithinTheBoundsAlsoFromBeyondThem) {
  Problem problem = answers(Shape::logistic, 0.0);
  problem.cells = {{0.1, {50, 100}}, {0.4, {75, 100}}, {0.8, {100, 100}}, {1.0, {100, 100}}};  // steep
  problem.upper[slope_index] = 0.1;
  const Maximum found = maximise(problem, somewhere, {});
  EXPECT_EQ(found.at[slope_index], 0.1);
  EXPECT_EQ(found.at[dispersion_index], 0.0);
}

// n / (p (1 - p)) times how p changes by each parameter; with a dispersion rho, 1 + (n - 1) rho times less.
TEST(Likelihood, InformationOfOneLevelIsFishers) {
  const auto log_p = [](const Point& point) {
    return log_likelihood({.cells = {{0.4, {1, 1}}}, .lower = {}, .upper = {}}, point);
  };
  const double p = std::exp(log_p(somewhere));
  for (const double theta : {0.0, 0.25}) {
    Problem problem{.cells = {{0.4, {15, 20}}}, .lower = {}, .upper = {0.0, 0.0, 0.0, 1.0}};
    const Score found = score(problem, moved(dispersion_index, theta));
    for (std::size_t i = 0; i < dispersion_index; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const auto change = [&](std::size_t k) {
          return p * slope_of([&](double value) { return log_p(moved(k, value)); }, somewhere[k]);
        };
        const double rho = theta / (1.0 + theta);
        const double fisher = 20.0 / (p * (1.0 - p)) / (1.0 + 19.0 * rho) * change(i) * change(j);
        EXPECT_NEAR(found.information[i][j], fisher, 1e-6 * std::abs(fisher)) << i << j;
      }
    }
  }
}

// Beta-binomial with a = p / theta and b = (1 - p) / theta, without the number of orders.
TEST(Likelihood, IsTheBetaBinomial) {
  const double p = std::exp(log_likelihood({.cells = {{0.4, {1, 1}}}, .lower = {}, .upper = {}}, somewhere));
  for (const Count count : {Count{15, 20}, Count{0, 20}, Count{20, 20}, Count{300, 400}}) {
    const Problem problem{.cells = {{0.4, count}}, .lower = {}, .upper = {0.0, 0.0, 0.0, 1.0}};
    const double theta = somewhere[dispersion_index];
    const double a = p / theta;
    const double b = (1.0 - p) / theta;
    const double expected =
        log_beta(count.successes + a, count.trials - count.successes + b) - log_beta(a, b);
    EXPECT_NEAR(log_likelihood(problem, somewhere), expected, 1e-9 * std::abs(expected)) << count.successes;
  }
}

}  // namespace
}  // namespace kerf::psychophysics
