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
  // A slope that the grid of slopes has.
  const Psychometric curve{.threshold = 0.1, .slope = 0.5 * std::pow(20.0, 8.0 / 14.0), .lapse = 0.02};
  const Threshold found = posterior_threshold(many_answers(curve), {});
  EXPECT_EQ(found.criterion, 0.75);
  EXPECT_NEAR(found.value, curve.intensity_at(0.75), 0.02 * curve.intensity_at(0.75));
  EXPECT_LT(found.interval.upper / found.interval.lower, 1.1);
  const Threshold higher = posterior_threshold(many_answers(curve), {.criterion = 0.9});
  EXPECT_NEAR(higher.value, curve.intensity_at(0.9), 0.02 * curve.intensity_at(0.9));
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
