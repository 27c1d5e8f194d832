#include "uncertainty/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::fitting {
namespace {

/// A process of first order, x_i = pole x_{i-1} + w_i, past its transient.
std::vector<double> first_order(double pole, double deviation) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  double x = 0.0;
  for (int i = -1000; i < 100'000; ++i) {
    x = pole * x + deviation * normal(random);
    if (i >= 0) values.push_back(7.0 + x);
  }
  return values;
}

// Its correlation at lag k is pole^k, so that 1 + 2 sum pole^k = (1 + pole) / (1 - pole).
TEST(CorrelationTime, OfAProcessOfFirstOrderIsTheSumOfItsCorrelations) {
  EXPECT_NEAR(correlation_time(first_order(0.5, 1.0)), 3.0, 0.05 * 3.0);
  EXPECT_NEAR(correlation_time(first_order(0.8, 1.0)), 9.0, 0.1 * 9.0);
}

TEST(CorrelationTime, DoesNotDependOnTheUnit) {
  EXPECT_NEAR(correlation_time(first_order(0.8, 1e-3)), correlation_time(first_order(0.8, 1e3)), 1e-6);
}

TEST(CorrelationTime, IsNeverLessThanASample) {
  EXPECT_EQ(correlation_time(first_order(-0.5, 1.0)), 1.0);
  EXPECT_EQ(correlation_time(std::vector<double>(50, 2.5)), 1.0);
}

/// That of the values in order.
double sorted_median(std::vector<double> values) {
  std::ranges::sort(values);
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

TEST(Median, OfVeryManyValuesIsTheOneInTheMiddleOfAllInOrder) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (const std::size_t count : {1UL, 2UL, 7UL, 8191UL, 8192UL, 30'000UL, 60'001UL}) {
    std::vector<double> noise(count);
    for (double& value : noise) value = std::abs(normal(random));
    EXPECT_EQ(median_of(noise), sorted_median(noise)) << count;
    for (double& value : noise) value = 0.1 * std::floor(10.0 * value);
    EXPECT_EQ(median_of(noise), sorted_median(noise)) << "of a coarse sensor, " << count;
    std::ranges::sort(noise);
    EXPECT_EQ(median_of(noise), sorted_median(noise)) << "in order, " << count;
  }
}

// One value in thirty, and those are all that is looked at first.
TEST(Median, IsFoundWhereAFewValuesMislead) {
  std::vector<double> values(61'440);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = i % 30 == 0 ? 1000.0 + static_cast<double>(i) : static_cast<double>(i % 7919);
  EXPECT_EQ(median_of(values), sorted_median(values));
}

TEST(StudentT, IsThatOfTheTables) {
  EXPECT_NEAR(student_t(0.95, 10.0), 2.228, 1e-3);
  EXPECT_NEAR(student_t(0.99, 5.0), 4.032, 1e-3);
  EXPECT_NEAR(student_t(0.95, 1e6), 1.960, 1e-3);
  EXPECT_EQ(student_t(0.95, 0.0), student_t(0.95, 1.0)) << "no fewer than one degree of freedom";
}

// SciPy: 2 * t.sf(2, 10), f.sf(4 / 3, 3, 10).
TEST(TwoSidedP, IsThatOfTOrOfFHoweverFarOut) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(two_sided_p(2.0, 10.0), 0.07338803, 1e-7);
  EXPECT_NEAR(two_sided_p(2.0, 10.0, 3), 0.3179711001, 1e-7);
  for (const std::size_t numbers : {1U, 3U}) {
    EXPECT_EQ(two_sided_p(0.0, 10.0, numbers), 1.0);
    EXPECT_LT(two_sided_p(1e200, 10.0, numbers), 1e-100);
    EXPECT_EQ(two_sided_p(infinite, 10.0, numbers), 0.0);
    EXPECT_GT(two_sided_p(1.0, infinite, numbers), 0.1);
    EXPECT_EQ(two_sided_p(1.0, std::nan(""), numbers), two_sided_p(1.0, 1.0, numbers))
        << "freedom is not known";
    EXPECT_TRUE(std::isnan(two_sided_p(std::nan(""), 10.0, numbers)));
  }
}

}  // namespace
}  // namespace kerf::fitting
