#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/dprime.h>

namespace kerf::psychophysics {
namespace {

constexpr double infinite = HUGE_VAL;

std::vector<Task> every_task() {
  return {{Decision::forced_choice, 2},
          {Decision::forced_choice, 3},
          {Decision::forced_choice, 8},
          {Decision::oddity},
          {Decision::abx_independent},
          {Decision::abx_differencing},
          {Decision::same_different},
          {Decision::same_different_differencing},
          {Decision::yes_no}};
}

TEST(DPrime, OfForcedChoiceAgreesWithTheTables) {
  EXPECT_NEAR(d_prime({Decision::forced_choice, 2}, 0.75), 0.954, 5e-4);
  // Hacker and Ratcliff [HackerRatcliff1979]; the values for d' = 1 also in Frijters, Kooistra and Vereijken
  // [Frijters1980].
  EXPECT_NEAR(proportion_correct({Decision::forced_choice, 2}, 1.0), 0.760, 5e-4);
  EXPECT_NEAR(proportion_correct({Decision::forced_choice, 3}, 1.0), 0.634, 5e-4);
  EXPECT_NEAR(proportion_correct({Decision::forced_choice, 4}, 1.0), 0.552, 5e-4);
  EXPECT_NEAR(proportion_correct({Decision::oddity}, 1.0), 0.418, 5e-4);
  EXPECT_NEAR(proportion_correct({Decision::oddity}, 2.0), 0.605, 5e-4);
}

// The mean of the largest of m normal numbers is known in closed form for 2 and 3.
TEST(DPrime, OfForcedChoiceBeginsWithTheSlopeOfTheLargestOfMany) {
  const double step = 1e-5;
  const auto slope = [&](int m) {
    return (proportion_correct({Decision::forced_choice, m}, step) -
            proportion_correct({Decision::forced_choice, m}, -step)) /
           (2.0 * step);
  };
  const double inverse_root_of_pi = std::numbers::inv_sqrtpi;
  EXPECT_NEAR(slope(2), inverse_root_of_pi / 2.0, 1e-9);
  EXPECT_NEAR(slope(3), 1.5 * inverse_root_of_pi / 3.0, 1e-9);
}

// Kaplan, Macmillan and Creelman [Kaplan1978] tabulate what these equations give: at d' = 1 the observers of
// ABX are right in 60.0 % (independent) and 58.2 % (differencing).
TEST(DPrime, OfAbxIsLessForDifferencing) {
  const auto normal = [](double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); };
  const double a = normal(1.0 / std::sqrt(2.0));
  const double b = normal(0.5);
  const double c = normal(1.0 / std::sqrt(6.0));
  EXPECT_NEAR(proportion_correct({Decision::abx_independent}, 1.0), a * b + (1.0 - a) * (1.0 - b), 1e-15);
  EXPECT_NEAR(proportion_correct({Decision::abx_differencing}, 1.0), a * c + (1.0 - a) * (1.0 - c), 1e-15);
  EXPECT_NEAR(proportion_correct({Decision::abx_independent}, 1.0), 0.600, 5e-4);
  EXPECT_NEAR(proportion_correct({Decision::abx_differencing}, 1.0), 0.582, 5e-4);
}

TEST(DPrime, OfSameDifferentIsAClosedForm) {
  // d' = 2 z((1 + sqrt(2 pc - 1)) / 2); for pc = 0.82, z(0.9) = 1.2815515655446004.
  EXPECT_NEAR(d_prime({Decision::same_different}, 0.82), 2.0 * 1.2815515655446004, 1e-12);
}

TEST(DPrime, OfSameDifferentByDifferencingIsThatOfTheBestCriterion) {
  // SciPy's largest over the criterion.
  EXPECT_NEAR(proportion_correct({Decision::same_different_differencing}, 1.0), 0.5557887117711169, 1e-12);
  EXPECT_NEAR(proportion_correct({Decision::same_different_differencing}, 2.0), 0.6796737199184382, 1e-12);
  EXPECT_NEAR(proportion_correct({Decision::same_different_differencing}, 3.0), 0.8017036054298037, 1e-12);
}

TEST(DPrime, ComesBackFromTheProportionOfEveryTask) {
  for (const Task& task : every_task()) {
    EXPECT_NEAR(proportion_correct(task, 0.0), chance_of(task), 1e-14);
    for (const double d : {0.2, 1.0, 2.5, 4.0})
      EXPECT_NEAR(d_prime(task, proportion_correct(task, d)), d, 1e-9);
  }
}

TEST(DPrime, IsZeroAtChanceAndInfiniteWhereAllIsRight) {
  for (const Task& task : every_task()) {
    EXPECT_NEAR(d_prime(task, chance_of(task)), 0.0, 1e-9);
    EXPECT_EQ(d_prime(task, 1.0), infinite);
  }
  EXPECT_EQ(d_prime({Decision::abx_independent}, 0.4), 0.0);
  EXPECT_NEAR(d_prime({Decision::forced_choice, 2}, 0.25), -0.954, 5e-4);
}

TEST(DPrime, OfACountTakesTheExactIntervalAlong) {
  const Task task{Decision::forced_choice, 2};
  const DPrime found = estimate_d_prime(task, {30, 40});
  const Interval rate = clopper_pearson({30, 40});
  EXPECT_NEAR(found.value, 0.954, 5e-4);
  EXPECT_DOUBLE_EQ(found.interval.lower, d_prime(task, rate.lower));
  EXPECT_DOUBLE_EQ(found.interval.upper, d_prime(task, rate.upper));
  // sqrt(pc (1 - pc) / n) sqrt2 / phi(z), phi(0.6745) = 0.31778
  EXPECT_NEAR(found.standard_error, std::sqrt(0.75 * 0.25 / 40.0) * std::numbers::sqrt2 / 0.31778, 1e-5);
}

TEST(DPrime, OfACountWithoutErrorsIsFiniteAndOpenAbove) {
  const DPrime found = estimate_d_prime({Decision::abx_differencing}, {10, 10});
  EXPECT_NEAR(found.value, d_prime({Decision::abx_differencing}, 10.5 / 11.0), 1e-12);
  EXPECT_EQ(found.interval.upper, infinite);
  EXPECT_TRUE(std::isinf(estimate_d_prime({Decision::abx_differencing}, {5, 10}).standard_error));
}

// Macmillan and Creelman [MacmillanCreelman2005], chapter 1: hits 0.8 and false alarms 0.4 give 1.095; 0.99
// and 0.01 give 4.65.
TEST(YesNo, AgreesWithMacmillanAndCreelman) {
  const Detection found = yes_no({80, 100}, {40, 100});
  EXPECT_NEAR(found.d_prime, 1.095, 5e-4);
  EXPECT_NEAR(found.criterion, -0.294, 5e-4);
  EXPECT_NEAR(yes_no({99, 100}, {1, 100}).d_prime, 4.65, 5e-3);
  EXPECT_NEAR(yes_no_d_prime(0.8, 0.4), 0.8416212 + 0.2533471, 1e-6) << "z of 0.8, less that of 0.4";
  // H (1 - H) / (n phi(zH)^2) + F (1 - F) / (n phi(zF)^2) with phi(0.8416) = 0.27996, phi(0.2533) = 0.38634
  EXPECT_NEAR(found.standard_error, std::sqrt(0.0016 / (0.27996 * 0.27996) + 0.0024 / (0.38634 * 0.38634)),
              1e-4);
  EXPECT_NEAR(found.criterion_standard_error, 0.5 * found.standard_error, 1e-12);
}

TEST(YesNo, HasALikelihoodIntervalThatTendsToTheNormalOne) {
  const Detection found = yes_no({80000, 100000}, {40000, 100000});
  EXPECT_NEAR(found.interval.lower, found.d_prime - 1.959964 * found.standard_error, 1e-4);
  EXPECT_NEAR(found.interval.upper, found.d_prime + 1.959964 * found.standard_error, 1e-4);
  EXPECT_EQ(yes_no({20, 20}, {3, 20}).interval.upper, infinite);
}

TEST(YesNo, CorrectsRatesOfNothingAndOfAll) {
  EXPECT_NEAR(yes_no({10, 10}, {0, 10}).d_prime, 2.0 * 1.6906216, 1e-6);  // z(10.5 / 11)
  EXPECT_NEAR(yes_no({8, 10}, {4, 10}, Correction::always).d_prime,
              d_prime({Decision::forced_choice, 2}, 8.5 / 11.0) / std::numbers::sqrt2 -
                  d_prime({Decision::forced_choice, 2}, 4.5 / 11.0) / std::numbers::sqrt2,
              1e-12);
  EXPECT_THROW((void)yes_no({10, 10}, {0, 10}, Correction::none), std::invalid_argument);
}

TEST(TwoInterval, IsYesNoOverTheRootOfTwo) {
  const Detection yes = yes_no({40, 50}, {20, 50});
  const Detection two = two_interval({40, 50}, {20, 50});
  EXPECT_NEAR(two.d_prime, yes.d_prime / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(two.standard_error, yes.standard_error / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(two.interval.upper, yes.interval.upper / std::numbers::sqrt2, 1e-9);
}

TEST(DPrime, RefusesWhatCannotBe) {
  EXPECT_THROW((void)proportion_correct({Decision::forced_choice, 1}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)proportion_correct({Decision::abx_independent}, -1.0), std::invalid_argument);
  EXPECT_THROW((void)proportion_correct({Decision::forced_choice, 2}, std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)d_prime({Decision::oddity}, 1.2), std::invalid_argument);
  EXPECT_THROW((void)estimate_d_prime({Decision::oddity}, {0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
