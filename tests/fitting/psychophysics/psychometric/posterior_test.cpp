#include <gtest/gtest.h>

#include <kerf/psychophysics/posterior.h>
#include <kerf/psychophysics/random.h>
#include <kerf/psychophysics/staircase.h>

namespace kerf::psychophysics {
namespace {

std::vector<Level> many_answers(const Psychometric& curve) {
  std::vector<Level> levels;
  for (const double intensity : {0.02, 0.05, 0.08, 0.12, 0.2, 0.4}) {
    const int trials = 20000;
    levels.push_back({intensity,
                      {.successes = static_cast<int>(std::lround(trials * curve.probability(intensity))),
                       .trials = trials}});
  }
  return levels;
}

TEST(Posterior, OfManyAnswersIsWhereTheCurveReachesTheCriterion) {
  for (const double slope : {0.7, 1.6, 2.77, 7.3}) {
    const Psychometric curve{.threshold = 0.1, .slope = slope, .lapse = 0.02};
    const Threshold found = posterior_threshold(many_answers(curve), {});
    EXPECT_EQ(found.criterion, 0.75);
    EXPECT_NEAR(found.value, curve.intensity_at(0.75), 0.02 * curve.intensity_at(0.75)) << slope;
    EXPECT_LT(found.interval.upper / found.interval.lower, 1.1) << slope;
    const Threshold higher = posterior_threshold(many_answers(curve), {.criterion = 0.9});
    EXPECT_NEAR(higher.value, curve.intensity_at(0.9), 0.02 * curve.intensity_at(0.9)) << slope;
  }
}

struct Dense {
  const char* name;
  std::vector<Level> levels;
  FitOptions options;
  double lower, median, upper;
};

// The numbers are those of posterior.py beside this file (NumPy 1.24, SciPy 1.10), which says of what
// grids. On 15 slopes and 4 lapse rates the upper end after the staircase was 4.9 % too far out, and that of
// a criterion that some lapse rates do not reach 18 %.
TEST(Posterior, EndsWhereThatOfADenseGridEnds) {
  const std::vector<Level> staircase{{0.4, {3, 3}},  {0.2828, {4, 4}}, {0.2, {7, 8}}, {0.1414, {9, 11}},
                                     {0.1, {8, 13}}, {0.0707, {4, 8}}, {0.05, {1, 3}}};
  const std::vector<Level> few{{0.05, {8, 15}}, {0.1, {12, 15}}, {0.2, {15, 15}}};
  const std::vector<Level> yes_no{
      {1.0, {2, 20}}, {1.5, {5, 20}}, {2.0, {11, 20}}, {3.0, {16, 20}}, {4.0, {19, 20}}};
  const std::vector<Level> three{{0.02, {11, 30}}, {0.04, {15, 30}}, {0.08, {22, 30}}, {0.16, {29, 30}}};
  const std::vector<Level> many{{0.02, {10365, 20000}}, {0.05, {12076, 20000}}, {0.08, {14425, 20000}},
                                {0.12, {17222, 20000}}, {0.2, {19425, 20000}},  {0.4, {19599, 20000}}};
  FitOptions two_thirds, logistic, gaussian, known_lapses, high;
  two_thirds.confidence = 0.68;
  logistic.shape = Shape::logistic;
  logistic.guess = 0.0;
  gaussian.shape = Shape::gaussian;
  gaussian.guess = 1.0 / 3.0;
  gaussian.criterion = 0.8;
  known_lapses.lapse = 0.02;
  high.largest_lapse = 0.1;
  high.criterion = 0.93;
  const std::vector<Dense> cases{
      {"staircase", staircase, {}, 0.083799902, 0.14046206, 0.29255533},
      {"few", few, {}, 0.048155036, 0.092561382, 0.14963601},
      {"few, 68 %", few, two_thirds, 0.071616287, 0.092561382, 0.11347986},
      {"yes or no, logistic", yes_no, logistic, 1.6447532, 1.9183416, 2.2363742},
      {"three, gaussian", three, gaussian, 0.066990997, 0.087967132, 0.13003416},
      {"known lapses", staircase, known_lapses, 0.084074955, 0.14191159, 0.29199255},
      {"criterion that some lapses do not reach", staircase, high, 0.1399133, 0.23715043, 1.4349566},
      {"many", many, {}, 0.086132801, 0.087152059, 0.088174069}};
  for (const Dense& dense : cases) {
    const Threshold found = posterior_threshold(dense.levels, dense.options);
    EXPECT_NEAR(found.interval.lower, dense.lower, 1e-3 * dense.lower) << dense.name;
    EXPECT_NEAR(found.value, dense.median, 1e-3 * dense.median) << dense.name;
    EXPECT_NEAR(found.interval.upper, dense.upper, 1e-3 * dense.upper) << dense.name;
  }
}

TEST(Posterior, IsOfTheAnswersAndNotOfTheirOrder) {
  const std::vector<Level> together{{0.05, {2, 3}}, {0.1, {2, 3}}, {0.2, {3, 3}}};
  const std::vector<Level> one_by_one{{0.2, {1, 1}},  {0.1, {0, 1}},  {0.2, {1, 1}},
                                      {0.05, {1, 1}}, {0.1, {1, 1}},  {0.05, {0, 1}},
                                      {0.2, {1, 1}},  {0.05, {1, 1}}, {0.1, {1, 1}}};
  const Threshold first = posterior_threshold(together, {});
  const Threshold second = posterior_threshold(one_by_one, {});
  EXPECT_EQ(first.value, second.value);
  EXPECT_EQ(first.interval.upper, second.interval.upper);
}

TEST(Posterior, OfNearlyNoAnswersIsOpen) {
  const std::vector<Level> two{{0.1, {.successes = 1, .trials = 1}}, {0.2, {.successes = 0, .trials = 1}}};
  const Threshold found = posterior_threshold(two, {});
  EXPECT_EQ(found.interval.upper, std::numeric_limits<double>::infinity());
}

TEST(Posterior, MovesWithTheUnitOfTheLevels) {
  std::vector<Level> levels{{0.05, {8, 15}}, {0.1, {12, 15}}, {0.2, {15, 15}}};
  const Threshold small = posterior_threshold(levels, {});
  for (Level& level : levels) level.intensity *= 1000.0;
  const Threshold large = posterior_threshold(levels, {});
  EXPECT_NEAR(large.value, 1000.0 * small.value, 1e-6 * large.value);
  EXPECT_NEAR(large.interval.upper, 1000.0 * small.interval.upper, 1e-6 * large.interval.upper);
}

/// A session of one observer along a staircase, as rows of one level each.
std::vector<Level> staircase_levels(const Psychometric& curve, std::uint64_t seed) {
  Random random(seed);
  Staircase staircase({.start = 0.4});
  std::vector<Level> levels;
  while (!staircase.finished()) {
    const double intensity = staircase.next();
    const bool is_right = random.chance(curve.probability(intensity));
    levels.push_back({intensity, {.successes = is_right ? 1 : 0, .trials = 1}});
    staircase.answer(is_right);
  }
  return levels;
}

TEST(Posterior, CoversTheThresholdAfterAStaircaseWhereProfileLikelihoodDoesNot) {
  const Psychometric curve{.threshold = 0.1, .slope = 2.0, .lapse = 0.01};
  const double truth = curve.intensity_at(0.75);
  int by_posterior = 0;
  int by_profile = 0;
  constexpr int sessions = 60;
  for (std::uint64_t seed = 1; seed <= sessions; ++seed) {
    const std::vector<Level> levels = staircase_levels(curve, seed);
    const auto covers = [truth](const Threshold& found) {
      return found.interval.lower <= truth && truth <= found.interval.upper ? 1 : 0;
    };
    by_posterior += covers(posterior_threshold(levels, {}));
    by_profile += covers(fit_psychometric(levels, {}).threshold);
  }
  EXPECT_GE(by_posterior, 54);  // 95 % and two deviations below
  EXPECT_LT(by_profile, by_posterior);
}

TEST(Posterior, RefusesWhatItDoesNotKnow) {
  const std::vector<Level> levels{{0.05, {8, 15}}, {0.1, {12, 15}}};
  EXPECT_THROW((void)posterior_threshold({}, {}), std::invalid_argument);
  EXPECT_THROW((void)posterior_threshold(levels, {.axis = Axis::linear}), std::invalid_argument);
  EXPECT_THROW((void)posterior_threshold(levels, {.overdispersed = true}), std::invalid_argument);
  EXPECT_THROW((void)posterior_threshold(levels, {.criterion = 0.4}), std::invalid_argument);
  EXPECT_THROW((void)posterior_threshold(levels, {.guess = -0.1}), std::invalid_argument);
  const std::vector<Level> zero{{0.0, {8, 15}}};
  EXPECT_THROW((void)posterior_threshold(zero, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
