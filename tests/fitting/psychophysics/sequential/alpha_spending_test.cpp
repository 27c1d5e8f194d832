#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/random.h>
#include <kerf/psychophysics/sequential/alpha_spending.h>
#include <kerf/psychophysics/sign_flips.h>

namespace kerf::psychophysics {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

constexpr auto obrien_fleming = SpendingFunction::obrien_fleming;
constexpr auto pocock = SpendingFunction::pocock;

std::vector<double> z_of(const AlphaSpending& spending, const std::vector<double>& information,
                         double full = 1.0) {
  std::vector<double> z;
  for (const SpendingBound& bound : spending_bounds(spending, information, full)) z.push_back(bound.z);
  return z;
}

const std::vector<double> five_looks{0.2, 0.4, 0.6, 0.8, 1.0};

// Of five equal looks, two-sided 5 %, as they are printed time and again since [LanDeMets1983].
TEST(AlphaSpending, HasThePublishedBoundsOfFiveLooks) {
  EXPECT_THAT(z_of({.function = obrien_fleming, .two_sided = true}, five_looks),
              Pointwise(DoubleNear(6e-4), std::vector<double>{4.877, 3.357, 2.680, 2.290, 2.031}));
  EXPECT_THAT(z_of({.function = pocock, .two_sided = true}, five_looks),
              Pointwise(DoubleNear(6e-4), std::vector<double>{2.438, 2.427, 2.410, 2.397, 2.386}));
}

// Where SciPy's multivariate normal probabilities meet what each look may spend.
TEST(AlphaSpending, AgreesWithMultivariateNormalProbabilitiesAtUnequalLooks) {
  const auto expect = [](const AlphaSpending& spending, const std::vector<double>& information,
                         const std::vector<double>& z) {
    EXPECT_THAT(z_of(spending, information), Pointwise(DoubleNear(2e-4), z));
  };
  const std::vector<double> half{0.5, 0.75, 1.0};
  const std::vector<double> early{0.2, 0.7, 1.0};
  expect({.function = obrien_fleming, .two_sided = true}, half, {2.9626, 2.3590, 2.0141});
  expect({.function = obrien_fleming, .two_sided = true}, early, {4.8769, 2.4380, 1.9999});
  expect({.function = pocock, .two_sided = true}, half, {2.1570, 2.3124, 2.3269});
  expect({.function = obrien_fleming}, half, {2.5380, 2.0159, 1.7201});
  expect({.function = obrien_fleming}, early, {4.2292, 2.0717, 1.7024});
  expect({.function = pocock}, early, {2.1762, 1.9021, 1.9795});
}

TEST(AlphaSpending, GivesOneLookAtTheEndAllOfAlpha) {
  for (const bool two_sided : {false, true}) {
    const auto bounds = spending_bounds({.alpha = 0.05, .two_sided = two_sided}, std::array{12.0}, 12.0);
    EXPECT_NEAR(bounds.front().nominal, 0.05, 1e-12);
    EXPECT_NEAR(bounds.front().z, two_sided ? 1.959964 : 1.644854, 1e-6);
  }
}

TEST(AlphaSpending, LeavesTheBoundOfALookToThoseBeforeIt) {
  const AlphaSpending spending{.function = pocock, .two_sided = true};
  const auto all = z_of(spending, {6.0, 9.0, 12.0}, 12.0);
  EXPECT_DOUBLE_EQ(z_of(spending, {6.0, 9.0}, 12.0)[1], all[1]) << "whatever is planned after it";
}

TEST(AlphaSpending, HasNothingForALookSoEarlyThatNothingIsSpentThere) {
  const auto bounds = spending_bounds({.function = obrien_fleming}, std::array{0.01, 1.0}, 1.0);
  EXPECT_TRUE(std::isinf(bounds[0].z));
  EXPECT_EQ(bounds[0].nominal, 0.0);
  EXPECT_NEAR(bounds[1].nominal, 0.05, 1e-12);
}

TEST(AlphaSpending, SpendsNoMoreThanAlphaBeyondWhatWasPlanned) {
  const auto bounds = spending_bounds({.function = pocock}, std::array{6.0, 12.0, 14.0}, 12.0);
  EXPECT_DOUBLE_EQ(bounds[1].spent, 0.05);
  EXPECT_DOUBLE_EQ(bounds[2].spent, 0.05);
  EXPECT_TRUE(std::isinf(bounds[2].z)) << "nothing is left";
}

TEST(AlphaSpending, HoldsALookAfterEachOfAHundred) {
  std::vector<double> information;
  for (int i = 1; i <= 100; ++i) information.push_back(i);
  const auto bounds = spending_bounds({.function = pocock}, information, 100.0);
  // By independent drawing of walks; the exact 99.9 % interval holds alpha.
  constexpr int walks = 20000;
  int crossed = 0;
  Random random(7);
  for (int walk = 0; walk < walks; ++walk) {
    double sum = 0.0;
    for (int i = 0; i < 100; ++i) {
      sum += random.normal();
      if (sum < bounds[static_cast<std::size_t>(i)].z * std::sqrt(i + 1.0)) continue;
      ++crossed;
      break;
    }
  }
  const Interval interval = clopper_pearson({.successes = crossed, .trials = walks}, 0.999);
  EXPECT_LE(interval.lower, 0.05);
  EXPECT_GE(interval.upper, 0.05);
}

TEST(AlphaSpending, RefusesWhatIsNoCourseOfAStudy) {
  EXPECT_THROW((void)spending_bounds({}, std::vector<double>{}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)spending_bounds({}, std::array{0.5, 0.5}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)spending_bounds({.alpha = 0.5}, std::array{1.0}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)spending_bounds({}, std::array{1.0}, 0.0), std::invalid_argument);
}

/// The share of studies, of subjects who answer by chance, whose flipped signs reach the bound of a look.
Interval false_alarms(const AlphaSpending& spending, const std::vector<int>& looks, int studies) {
  std::vector<double> information(looks.begin(), looks.end());
  const auto bounds = spending_bounds(spending, information, information.back());
  Random random(11);
  int alarms = 0;
  std::vector<double> beyond;
  for (int study = 0; study < studies; ++study) {
    beyond.clear();
    for (int subject = 0; subject < looks.back(); ++subject) {
      int right = 0;
      for (int trial = 0; trial < 12; ++trial) right += static_cast<int>(random.below(2));
      beyond.push_back(right / 12.0 - 0.5);
    }
    bool is_alarm = false;
    for (std::size_t look = 0; look < looks.size() && !is_alarm; ++look) {
      const SignFlips flips = flip_signs(std::span(beyond).first(static_cast<std::size_t>(looks[look])));
      is_alarm = (spending.two_sided ? flips.p_two_sided : flips.p_greater) <= bounds[look].nominal;
    }
    alarms += is_alarm ? 1 : 0;
  }
  return clopper_pearson({.successes = alarms, .trials = studies}, 0.999);
}

TEST(AlphaSpending, KeepsTheFalseAlarmsOfFlippedSignsAtAlpha) {
  constexpr int studies = 10000;
  for (const auto function : {obrien_fleming, pocock}) {
    for (const bool two_sided : {false, true}) {
      const Interval interval =
          false_alarms({.function = function, .two_sided = two_sided}, {8, 14, 20}, studies);
      EXPECT_LE(interval.lower, 0.05);
      EXPECT_GE(interval.upper, 0.03) << "and spends most of it";
    }
  }
}

}  // namespace
}  // namespace kerf::psychophysics
