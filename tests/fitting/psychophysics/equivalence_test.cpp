#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/psychophysics/equivalence.h>

namespace kerf::psychophysics {
namespace {

TEST(Equivalence, OfAProportionIsTwoBinomialTests) {
  const Equivalence found = equivalent_proportion({52, 100}, 0.5, 0.15);
  EXPECT_DOUBLE_EQ(found.p, binomial_test({52, 100}, 0.65, Alternative::less));
  EXPECT_LT(binomial_test({52, 100}, 0.35, Alternative::greater), found.p);
  EXPECT_TRUE(found.is_shown);
  EXPECT_FALSE(equivalent_proportion({52, 100}, 0.5, 0.05).is_shown);
}

TEST(Equivalence, IsAnIntervalOfNinetyPercentWithinTheMargins) {
  for (int k = 30; k <= 70; ++k) {
    const Equivalence found = equivalent_proportion({k, 100}, 0.5, 0.12);
    EXPECT_EQ(found.is_shown, lies_within(found.interval, {0.38, 0.62})) << k;
  }
}

TEST(Equivalence, HoldsForAnyMarginWiderThanTheOneExcluded) {
  const double margin = excluded_margin({52, 100}, 0.5);
  EXPECT_TRUE(equivalent_proportion({52, 100}, 0.5, margin + 1e-9).is_shown);
  EXPECT_FALSE(equivalent_proportion({52, 100}, 0.5, margin - 1e-9).is_shown);
}

TEST(Equivalence, OfADiscriminationIsOneBinomialTest) {
  const Task abx{Decision::abx_differencing};
  const Equivalence found = below_d_prime(abx, {52, 100}, 1.5);
  EXPECT_DOUBLE_EQ(found.p, binomial_test({52, 100}, proportion_correct(abx, 1.5), Alternative::less));
  const double excluded = excluded_d_prime(abx, {52, 100});
  EXPECT_TRUE(below_d_prime(abx, {52, 100}, excluded + 1e-6).is_shown);
  EXPECT_FALSE(below_d_prime(abx, {52, 100}, excluded - 1e-6).is_shown);
  EXPECT_TRUE(std::isinf(excluded_d_prime(abx, {10, 10})));
}

TEST(Equivalence, OfAnEstimateIsTheWorseOfTwoTails) {
  // 0.4 of 1 is two standard errors from 0.8 and six from -0.8: P(z > 2) = 0.0227501319.
  EXPECT_NEAR(equivalent_estimate({.value = 0.4, .standard_error = 0.2}, {-0.8, 0.8}).p, 0.0227501319, 1e-9);
  // Student's t with one degree: P(t > 1) = 1/4.
  EXPECT_NEAR(
      equivalent_estimate({.value = 0.0, .standard_error = 1.0, .degrees_of_freedom = 1.0}, {-1.0, 1.0}).p,
      0.25, 1e-12);
}

TEST(Equivalence, RaisesNoMoreFalseAlarmsThanItSays) {
  for (const int n : {20, 57, 100, 333}) {
    EXPECT_LE(equivalence_power({.truth = 0.6}, n), 0.05) << n;
    EXPECT_LE(equivalence_power({.truth = 0.4}, n), 0.05) << n;
  }
}

TEST(Equivalence, TakesManyTrials) {
  const EquivalenceDesign design{.centre = 0.5, .margin = 0.1, .truth = 0.5};
  const int trials = trials_for_equivalence(design);
  EXPECT_LT(equivalence_power(design, trials - 1), 0.8);
  for (int n = trials; n < trials + 40; ++n) EXPECT_GE(equivalence_power(design, n), 0.8) << n;
  // (z(0.95) + z(0.9))^2 / 4 / 0.1^2 = 214 by the normal approximation
  EXPECT_NEAR(trials, 214, 15);
}

TEST(Equivalence, RefusesWhatCannotBe) {
  EXPECT_THROW((void)equivalent_proportion({1, 2}, 0.5, 0.0), std::invalid_argument);
  EXPECT_THROW((void)equivalent_proportion({1, 2}, 0.5, 0.1, 0.6), std::invalid_argument);
  EXPECT_THROW((void)equivalent_proportion({0, 0}, 0.5, 0.1), std::invalid_argument);
  EXPECT_THROW((void)below_d_prime({}, {1, 2}, 0.0), std::invalid_argument);
  EXPECT_THROW((void)equivalent_estimate({.value = 0.0, .standard_error = 0.0}, {-1.0, 1.0}),
               std::invalid_argument);
  EXPECT_THROW((void)trials_for_equivalence({.truth = 0.7}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
