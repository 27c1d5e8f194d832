#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/psychophysics/binomial.h>

namespace kerf::psychophysics {
namespace {

// Conover [Conover1971], p. 97, as in R's help on binom.test.
TEST(BinomialTest, AgreesWithConoversPeas) {
  EXPECT_NEAR(binomial_test({682, 925}, 0.75), 0.3824915595, 1e-9);
  const Interval interval = clopper_pearson({682, 925});
  EXPECT_NEAR(interval.lower, 0.7076683, 5e-8);
  EXPECT_NEAR(interval.upper, 0.7654066, 5e-8);
}

TEST(BinomialTest, IsAClosedFormForFewTrials) {
  EXPECT_DOUBLE_EQ(binomial_test({0, 3}, 0.5), 0.25);
  EXPECT_DOUBLE_EQ(binomial_test({9, 10}, 0.5), 22.0 / 1024.0);
  EXPECT_DOUBLE_EQ(binomial_test({9, 10}, 0.5, Alternative::greater), 11.0 / 1024.0);
  EXPECT_DOUBLE_EQ(binomial_test({1, 10}, 0.5, Alternative::less), 11.0 / 1024.0);
  EXPECT_DOUBLE_EQ(binomial_test({5, 10}, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(binomial_test({0, 0}, 0.5), 1.0);
}

TEST(BinomialTest, SumsSmallProbabilitiesOnBothSidesOfASkewedNull) {
  // P(X = i) for n = 3, p = 1/3: 8, 12, 6, 1 of 27. Two or more are as likely or less than two, and so is
  // nothing else.
  EXPECT_NEAR(binomial_test({2, 3}, 1.0 / 3.0), 7.0 / 27.0, 1e-14);
  EXPECT_NEAR(binomial_test({0, 3}, 1.0 / 3.0), 15.0 / 27.0, 1e-14);
}

// Newcombe [Newcombe1998], table I: the same four counts by several methods.
struct Published {
  Count count;
  Interval exact, score;
};

TEST(BinomialInterval, AgreesWithNewcombesTable) {
  const Published rows[] = {{{81, 263}, {0.2527, 0.3676}, {0.2553, 0.3662}},
                            {{15, 148}, {0.0578, 0.1617}, {0.0624, 0.1605}},
                            {{0, 20}, {0.0, 0.1684}, {0.0, 0.1611}},
                            {{1, 29}, {0.0009, 0.1776}, {0.0061, 0.1718}}};
  for (const Published& row : rows) {
    const Interval exact = clopper_pearson(row.count);
    const Interval score = wilson(row.count);
    EXPECT_NEAR(exact.lower, row.exact.lower, 5e-5);
    EXPECT_NEAR(exact.upper, row.exact.upper, 5e-5);
    EXPECT_NEAR(score.lower, row.score.lower, 5e-5);
    EXPECT_NEAR(score.upper, row.score.upper, 5e-5);
  }
}

TEST(BinomialInterval, EndsWhereOneSidedTestsRefuse) {
  const Interval interval = clopper_pearson({13, 40}, 0.9);
  EXPECT_NEAR(binomial_test({13, 40}, interval.lower, Alternative::greater), 0.05, 1e-12);
  EXPECT_NEAR(binomial_test({13, 40}, interval.upper, Alternative::less), 0.05, 1e-12);
}

TEST(BinomialPower, IsTheChanceOfTheCriticalCount) {
  // 15 of 20 are needed (P = 0.0207 by chance, 0.0577 for 14); P(X >= 15 | 0.8) = 0.8042.
  const BinomialDesign design{.truth = 0.8, .alternative = Alternative::greater};
  EXPECT_NEAR(binomial_power(design, 20), 0.80421, 5e-6);
  EXPECT_NEAR(binomial_power({.truth = 0.5, .alternative = Alternative::greater}, 20), 0.02069, 5e-6);
}

TEST(BinomialPower, NeverRaisesMoreFalseAlarmsThanItSays) {
  for (int n = 1; n <= 60; ++n) {
    for (const double chance : {0.5, 1.0 / 3.0, 0.1}) {
      EXPECT_LE(binomial_power({.chance = chance, .truth = chance}, n), 0.05) << n << " trials at " << chance;
    }
  }
}

TEST(BinomialPower, StaysAboveWhatWasAskedFromTheTrialsOn) {
  for (const double truth : {0.3, 0.65, 0.9}) {
    const BinomialDesign design{.truth = truth};
    const int trials = trials_for_power(design, 0.8);
    EXPECT_LT(binomial_power(design, trials - 1), 0.8);
    for (int n = trials; n < trials + 50; ++n) EXPECT_GE(binomial_power(design, n), 0.8) << n;
  }
}

TEST(Binomial, RefusesWhatCannotBe) {
  EXPECT_THROW((void)binomial_test({4, 3}, 0.5), std::invalid_argument);
  EXPECT_THROW((void)binomial_test({-1, 3}, 0.5), std::invalid_argument);
  EXPECT_THROW((void)binomial_test({1, 3}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)clopper_pearson({1, 3}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)wilson({0, 0}), std::invalid_argument);
  EXPECT_THROW((void)trials_for_power({.truth = 0.5}), std::invalid_argument);
  EXPECT_THROW((void)trials_for_power({.truth = 0.4, .alternative = Alternative::greater}),
               std::invalid_argument);
  EXPECT_THROW((void)trials_for_power({.truth = 0.5001}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
