#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/comparisons.h>

namespace kerf::psychophysics {
namespace {

// [Agresti], American League 1987, 13 games a pair. Milwaukee, Detroit, Toronto, New
// York, Boston, Cleveland, Baltimore.
const Wins& baseball() {
  static const Wins wins{{0, 7, 9, 7, 7, 9, 11}, {6, 0, 7, 5, 11, 9, 9}, {4, 6, 0, 7, 7, 8, 12},
                         {6, 8, 6, 0, 6, 7, 10}, {6, 2, 6, 7, 0, 7, 12}, {4, 4, 5, 6, 6, 0, 6},
                         {2, 4, 1, 3, 1, 7, 0}};
  return wins;
}

TEST(BradleyTerry, AgreesWithAgrestisBaseball) {
  const Ranking found = rank(baseball());
  const double worth[] = {1.581, 1.436, 1.294, 1.248, 1.108, 0.684};  // over Baltimore
  const double error[] = {0.343, 0.340, 0.337, 0.336, 0.334, 0.332};
  for (std::size_t i = 0; i < 6; ++i) {
    const Difference over_baltimore = difference(found, i, 6);
    EXPECT_NEAR(over_baltimore.value, worth[i], 1e-3);
    EXPECT_NEAR(over_baltimore.standard_error, error[i], 1e-3);
  }
  EXPECT_NEAR(found.deviance, 15.737, 1e-3);
  EXPECT_EQ(found.deviance_degrees_of_freedom, 15);
  EXPECT_EQ(found.ratio_degrees_of_freedom, 6);
}

TEST(BradleyTerry, OfTwoItemsIsTheLogOfTheOdds) {
  const Ranking found = rank({{0, 30}, {10, 0}});
  const Difference first = difference(found, 0, 1);
  EXPECT_NEAR(first.value, std::log(3.0), 1e-10);
  EXPECT_NEAR(first.standard_error, std::sqrt(1.0 / 30.0 + 1.0 / 10.0), 1e-10);
  EXPECT_NEAR(found.ratio, 2.0 * (30.0 * std::log(1.5) + 10.0 * std::log(0.5)), 1e-10);
  EXPECT_EQ(found.deviance_p, 1.0);
}

TEST(Thurstone, OfTwoItemsIsTheDPrimeOfAForcedChoice) {
  const Ranking found = rank({{0, 30}, {10, 0}}, Scale::thurstone);
  EXPECT_NEAR(difference(found, 0, 1).value, std::numbers::sqrt2 * 0.6744897501960817, 1e-9);
}

TEST(Ranking, FindsTheWorthThatMadeExactCounts) {
  // Odds of 1 : 2 : 4, so that each pair is won in whole numbers.
  const Ranking found = rank({{0, 200, 120}, {400, 0, 200}, {480, 400, 0}});
  EXPECT_NEAR(found.worth[1] - found.worth[0], std::log(2.0), 1e-9);
  EXPECT_NEAR(found.worth[2] - found.worth[1], std::log(2.0), 1e-9);
  EXPECT_NEAR(found.worth[0] + found.worth[1] + found.worth[2], 0.0, 1e-12);
  EXPECT_NEAR(found.deviance, 0.0, 1e-8);
}

TEST(Ranking, IsCertainOfTheSumOfItsWorths) {
  const Ranking found = rank(baseball());
  for (const auto& row : found.covariance) EXPECT_NEAR(std::reduce(row.begin(), row.end()), 0.0, 1e-9);
}

TEST(Ranking, OfEqualItemsIsNoAlarm) {
  const Ranking found = rank({{0, 5, 5}, {5, 0, 5}, {5, 5, 0}});
  EXPECT_NEAR(found.ratio, 0.0, 1e-12);
  EXPECT_NEAR(found.ratio_p, 1.0, 1e-12);
  EXPECT_NEAR(difference(found, 0, 2).p, 1.0, 1e-12);
}

TEST(Ranking, RefusesItemsWithoutAFiniteWorth) {
  EXPECT_THROW((void)rank({{0, 5}, {0, 0}}), std::invalid_argument);
  EXPECT_THROW((void)rank({{0, 3, 2}, {3, 0, 1}, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW((void)rank({{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 1, 0}}), std::invalid_argument);
  EXPECT_THROW((void)rank({{0, 1}, {1}}), std::invalid_argument);
  EXPECT_THROW((void)rank({{0}}), std::invalid_argument);
  EXPECT_THROW((void)difference(rank({{0, 3}, {2, 0}}), 1, 1), std::invalid_argument);
}

// Worked by hand: sorted 0.005, 0.01, 0.03, 0.04 times 4, 3, 2, 1, and times 4/1, 4/2, 4/3, 4/4.
TEST(ManyComparisons, AreCorrectedStepByStep) {
  const std::vector<double> p{0.01, 0.04, 0.03, 0.005};
  const std::vector<double> by_holm{0.03, 0.06, 0.06, 0.02};
  const std::vector<double> by_benjamini{0.02, 0.04, 0.04, 0.02};
  const std::vector<double> first = holm(p);
  const std::vector<double> second = benjamini_hochberg(p);
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(first[i], by_holm[i], 1e-15);
    EXPECT_NEAR(second[i], by_benjamini[i], 1e-15);
  }
}

// Benjamini and Hochberg [BenjaminiHochberg1995], section 3.2: fifteen hypotheses, of which their procedure
// rejects four at 0.05 and Bonferroni's three.
TEST(ManyComparisons, RejectWhatBenjaminiAndHochbergReject) {
  const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                              0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0};
  int discoveries = 0;
  for (const double adjusted : benjamini_hochberg(p)) discoveries += adjusted <= 0.05 ? 1 : 0;
  EXPECT_EQ(discoveries, 4);
  int alarms = 0;
  for (const double adjusted : holm(p)) alarms += adjusted <= 0.05 ? 1 : 0;
  EXPECT_EQ(alarms, 3);
}

TEST(ManyComparisons, RefuseWhatIsNoProbability) {
  EXPECT_THROW((void)holm(std::vector<double>{0.1, 1.2}), std::invalid_argument);
  EXPECT_THROW((void)benjamini_hochberg(std::vector<double>{std::nan("")}), std::invalid_argument);
  EXPECT_TRUE(holm(std::vector<double>{}).empty());
}

}  // namespace
}  // namespace kerf::psychophysics
