#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/psychometric_fit.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

/// What an observer answers in so many trials that chance plays no part.
std::vector<Level> exact_answers(const Psychometric& observer, const std::vector<double>& intensities) {
  std::vector<Level> levels;
  constexpr int trials = 1'000'000'000;
  for (const double x : intensities) {
    levels.push_back({x, {static_cast<int>(std::lround(observer.probability(x) * trials)), trials}});
  }
  return levels;
}

std::vector<Level> some_answers() {
  return {{0.5, {22, 40}}, {0.7, {23, 40}}, {0.9, {30, 40}},
          {1.2, {35, 40}}, {1.6, {38, 40}}, {2.2, {39, 40}}};
}

class EveryShape : public testing::TestWithParam<Shape> {};

TEST_P(EveryShape, IsFoundFromTheAnswersOfItsObserver) {
  for (const double lapse : {0.0, 0.03}) {
    const Psychometric observer{
        .shape = GetParam(), .threshold = 1.1, .slope = 2.3, .guess = 0.5, .lapse = lapse};
    const auto levels = exact_answers(observer, {0.0, 0.3, 0.6, 0.9, 1.2, 1.8, 3.0, 6.0});
    const PsychometricFit fit = fit_psychometric(levels, {.shape = GetParam()});
    EXPECT_NEAR(fit.curve.threshold, 1.1, 1e-4);
    EXPECT_NEAR(fit.curve.slope, 2.3, 1e-3);
    EXPECT_NEAR(fit.curve.lapse, lapse, 1e-4);
    EXPECT_NEAR(fit.threshold.value, observer.intensity_at(0.75), 1e-4);
    EXPECT_EQ(fit.threshold.criterion, 0.75);
    EXPECT_NEAR(fit.deviance, 0.0, 1.0);
    EXPECT_EQ(fit.degrees_of_freedom, 5);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape,
                         testing::Values(Shape::weibull, Shape::logistic, Shape::gaussian));

TEST(PsychometricFit, OfTwoLevelsGoesThroughBoth) {
  // Two parameters, two proportions: ln(p / (1 - p)) is 0 at 1 and ln 3 at 2.
  const std::vector<Level> levels{{1.0, {20, 40}}, {2.0, {30, 40}}};
  const PsychometricFit fit =
      fit_psychometric(levels, {.shape = Shape::logistic, .axis = Axis::linear, .guess = 0.0, .lapse = 0.0});
  EXPECT_NEAR(fit.curve.threshold, 1.0, 1e-6);
  EXPECT_NEAR(fit.curve.slope, std::log(3.0), 1e-6);
  EXPECT_NEAR(fit.deviance, 0.0, 1e-9);
  EXPECT_NEAR(fit.log_likelihood, 40.0 * std::log(0.5) + 30.0 * std::log(0.75) + 10.0 * std::log(0.25), 1e-9);
  EXPECT_NEAR(half_interquartile(fit).value, 1.0, 1e-6);
}

TEST(PsychometricFit, WidensItsIntervalWithTheConfidence) {
  // An interval of more confidence holds that of less, and both hold the estimate.
  const PsychometricFit wide = fit_psychometric(some_answers(), {.confidence = 0.99});
  const PsychometricFit usual = fit_psychometric(some_answers(), {});
  EXPECT_LT(wide.threshold.interval.lower, usual.threshold.interval.lower);
  EXPECT_LT(usual.threshold.interval.lower, usual.threshold.value);
  EXPECT_LT(usual.threshold.value, usual.threshold.interval.upper);
  EXPECT_LT(usual.threshold.interval.upper, wide.threshold.interval.upper);
}

/// Largest log-likelihood of Weibull curves that reach 75 % at a threshold, by trying 60,000 slopes and lapse
/// rates.
double best_by_trying(const std::vector<Level>& levels, double threshold) {
  const double steepest = 1000.0 / std::log(2.2 / 0.5);  // what counts as a step: 1 / 1000 of the levels
  double best = -1e9;
  for (int i = 0; i <= 1200; ++i) {
    const double slope = 0.04 * std::pow(steepest / 0.04, i / 1200.0);
    for (int j = 0; j <= 50; ++j) {
      const double lapse = 0.06 * j / 50.0;
      const double z = std::log(-std::log(1.0 - 0.25 / (0.5 - lapse)));
      const Psychometric curve{.threshold = threshold * std::exp(-z / slope), .slope = slope, .lapse = lapse};
      double sum = 0.0;
      for (const Level& level : levels) {
        const double p = std::min(curve.probability(level.intensity), 1.0 - 1e-12);
        sum += level.answers.successes * std::log(p) +
               (level.answers.trials - level.answers.successes) * std::log(1.0 - p);
      }
      best = std::max(best, sum);
    }
  }
  return best;
}

// In these answers a step between two levels is nearly as likely as a gentle slope, and one start does not
// find both.
TEST(PsychometricFit, EndsItsIntervalWhereNoCurveIsLikelyEnough) {
  const std::vector<Level> levels{{0.5, {13, 20}}, {0.7, {13, 20}}, {0.9, {13, 20}},
                                  {1.2, {18, 20}}, {1.6, {20, 20}}, {2.2, {20, 20}}};
  const PsychometricFit fit = fit_psychometric(levels, {});
  for (const double end : {fit.threshold.interval.lower, fit.threshold.interval.upper}) {
    EXPECT_NEAR(2.0 * (fit.log_likelihood - best_by_trying(levels, end)), 3.841, 0.02);
  }
}

TEST(PsychometricFit, DoesNotDependOnTheUnitOfTheIntensity) {
  std::vector<Level> levels = some_answers();
  const PsychometricFit newtons = fit_psychometric(levels, {});
  for (Level& level : levels) level.intensity *= 1000.0;
  const PsychometricFit millinewtons = fit_psychometric(levels, {});
  EXPECT_NEAR(millinewtons.threshold.value, 1000.0 * newtons.threshold.value, 1e-5);
  EXPECT_NEAR(millinewtons.threshold.interval.upper, 1000.0 * newtons.threshold.interval.upper, 1e-4);
  EXPECT_NEAR(millinewtons.slope, newtons.slope, 1e-7);
}

TEST(PsychometricFit, IsTheSameForTrialsOneByOne) {
  std::vector<Level> single;
  for (const Level& level : some_answers()) {
    for (int i = 0; i < level.answers.trials; ++i)
      single.push_back({level.intensity, {i < level.answers.successes ? 1 : 0, 1}});
  }
  const PsychometricFit together = fit_psychometric(some_answers(), {});
  const PsychometricFit apart = fit_psychometric(single, {});
  EXPECT_NEAR(apart.threshold.value, together.threshold.value, 1e-7);
  EXPECT_NEAR(apart.threshold.interval.lower, together.threshold.interval.lower, 1e-6);
}

TEST(PsychometricFit, LeavesOpenWhatTheAnswersDoNotClose) {
  const PsychometricFit guessing =
      fit_psychometric(std::vector<Level>{{0.5, {10, 20}}, {1.0, {11, 20}}, {2.0, {10, 20}}}, {});
  EXPECT_TRUE(std::isinf(guessing.threshold.interval.upper));
  const PsychometricFit all_right =
      fit_psychometric(std::vector<Level>{{0.5, {20, 20}}, {1.0, {20, 20}}, {2.0, {20, 20}}}, {});
  EXPECT_EQ(all_right.threshold.interval.lower, 0.0);
  EXPECT_LE(all_right.threshold.interval.upper, 0.5);
  const PsychometricFit step = fit_psychometric(
      std::vector<Level>{{0.5, {0, 20}}, {1.0, {0, 20}}, {2.0, {20, 20}}, {4.0, {20, 20}}}, {.guess = 0.0});
  EXPECT_GE(step.threshold.interval.lower, 0.9);
  EXPECT_LE(step.threshold.interval.upper, 2.1);
  EXPECT_TRUE(std::isinf(step.slope_interval.upper));
}

TEST(PsychometricFit, HoldsALapseRateThatIsGiven) {
  EXPECT_EQ(fit_psychometric(some_answers(), {.lapse = 0.01}).curve.lapse, 0.01);
  const double found = fit_psychometric(some_answers(), {}).curve.lapse;
  EXPECT_GE(found, 0.0);
  EXPECT_LE(found, 0.06);
}

TEST(PsychometricFit, FindsOverdispersionAndWidensItsIntervals) {
  const Psychometric observer{.threshold = 1.0, .slope = 2.5, .guess = 0.5, .lapse = 0.02};
  Random random(11);
  std::vector<Level> spread;
  std::vector<Level> even;
  for (int subject = 0; subject < 40; ++subject) {
    for (const double x : {0.5, 0.8, 1.2, 2.0}) {
      spread.push_back({x, {random.successes(30, observer.probability(x), 0.15), 30}});
      even.push_back({x, {random.successes(30, observer.probability(x)), 30}});
    }
  }
  const PsychometricFit found = fit_psychometric(spread, {.overdispersed = true});
  EXPECT_NEAR(found.overdispersion, 0.15, 0.05);
  EXPECT_LT(found.overdispersion_p, 1e-6);
  const PsychometricFit blind = fit_psychometric(spread, {});
  EXPECT_GT(found.threshold.interval.upper - found.threshold.interval.lower,
            1.5 * (blind.threshold.interval.upper - blind.threshold.interval.lower));
  EXPECT_LT(fit_psychometric(even, {.overdispersed = true}).overdispersion, 0.02);
}

TEST(Bootstrap, AgreesWithTheProfileAndFollowsItsSeed) {
  const PsychometricFit fit = fit_psychometric(some_answers(), {});
  const Bootstrap found = bootstrap(fit, some_answers(), {}, {.samples = 400, .seed = 3});
  EXPECT_NEAR(found.threshold.lower, fit.threshold.interval.lower, 0.05);
  EXPECT_NEAR(found.threshold.upper, fit.threshold.interval.upper, 0.05);
  EXPECT_EQ(found.threshold.lower,
            bootstrap(fit, some_answers(), {}, {.samples = 400, .seed = 3}).threshold.lower);
  EXPECT_GT(found.deviance_p, 0.05);
}

TEST(Bootstrap, RefusesACurveThatDoesNotFit) {
  // Up, down and up again.
  const std::vector<Level> levels{
      {0.5, {38, 40}}, {0.8, {20, 40}}, {1.2, {38, 40}}, {1.8, {22, 40}}, {2.5, {39, 40}}};
  const double p = bootstrap(fit_psychometric(levels, {}), levels, {}, {.samples = 200}).deviance_p;
  EXPECT_LT(p, 0.01);
  EXPECT_GE(p, 1.0 / 201.0) << "no number of samples shows that a deviance cannot be";
}

TEST(AcrossSubjects, IsStudentsIntervalOfTheLogarithms) {
  std::vector<PsychometricFit> fits(3);
  const double thresholds[] = {1.0, 2.0, 4.0};
  for (std::size_t i = 0; i < 3; ++i) fits[i].threshold = {.value = thresholds[i], .criterion = 0.75};
  const AcrossSubjects found = across_subjects(fits);
  EXPECT_NEAR(found.mean, 2.0, 1e-12);
  EXPECT_NEAR(found.deviation, std::log(2.0), 1e-12);
  const double half = 4.302652729911275 * std::log(2.0) / std::sqrt(3.0);
  EXPECT_NEAR(found.interval.upper, 2.0 * std::exp(half), 1e-9);
  EXPECT_NEAR(found.interval.lower, 2.0 * std::exp(-half), 1e-9);
  EXPECT_THROW((void)across_subjects(std::vector<PsychometricFit>(1)), std::invalid_argument);
}

TEST(PsychometricFit, RefusesWhatCannotBeFitted) {
  const std::vector<Level> one{{1.0, {3, 4}}};
  EXPECT_THROW((void)fit_psychometric(one, {}), std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(std::vector<Level>{}, {}), std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(some_answers(), {.axis = Axis::linear}), std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(some_answers(), {.criterion = 0.96}), std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(some_answers(), {.criterion = 0.5}), std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(some_answers(), {.guess = 1.0}), std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(some_answers(), {.confidence = 1.0}), std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(std::vector<Level>{{-1.0, {1, 2}}, {1.0, {1, 2}}}, {}),
               std::invalid_argument);
  EXPECT_THROW((void)fit_psychometric(std::vector<Level>{{1.0, {3, 2}}, {2.0, {1, 2}}}, {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
