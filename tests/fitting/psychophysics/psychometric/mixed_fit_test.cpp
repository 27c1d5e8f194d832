#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/mixed_fit.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

using Subjects = std::vector<std::vector<Level>>;

/// Twelve simulated subjects, 16 answers a level: PSE 0.02 +- 0.1, slope 8 times exp(0.3 z).
const Subjects& answers() {
  static const Subjects all = [] {
    const int more[12][7] = {{0, 0, 2, 10, 10, 15, 16}, {0, 4, 8, 13, 15, 16, 16}, {0, 0, 0, 1, 1, 5, 7},
                             {1, 1, 4, 7, 8, 13, 14},   {3, 4, 4, 13, 14, 14, 14}, {0, 2, 6, 10, 9, 14, 14},
                             {0, 0, 1, 3, 15, 15, 16},  {0, 0, 1, 6, 11, 15, 15},  {0, 0, 0, 6, 5, 15, 15},
                             {0, 0, 1, 5, 9, 16, 16},   {0, 0, 0, 1, 9, 9, 15},    {0, 3, 3, 7, 11, 12, 15}};
    Subjects subjects;
    for (const auto& row : more) {
      std::vector<Level>& levels = subjects.emplace_back();
      for (int i = 0; i < 7; ++i)
        levels.push_back({.intensity = 0.1 * (i - 3), .answers = {.successes = row[i], .trials = 16}});
    }
    return subjects;
  }();
  return all;
}

MixedOptions probit(bool slopes_differ) {
  return {.shape = Shape::gaussian,
          .axis = Axis::linear,
          .two_sided = true,
          .lapse = 0.0,
          .slopes_differ = slopes_differ};
}

// glmer(cbind(k, 16 - k) ~ x + (1 | s), family = binomial("probit"), nAGQ = 25): intercept -0.3541794, slope
// 6.6898275, deviation of the intercept 0.61466; log-likelihood by R's integrate().
TEST(MixedFit, WithOneSlopeIsThatOfLme4) {
  const MixedFit fit = fit_mixed(answers(), probit(false));
  EXPECT_NEAR(fit.threshold.mean, 0.05294299, 1e-5);
  EXPECT_NEAR(fit.slope.mean, 6.6898275, 1e-4);
  EXPECT_NEAR(fit.threshold.deviation, 0.0918792691, 1e-5);
  EXPECT_NEAR(fit.log_likelihood, -500.8014849458, 1e-4);
  EXPECT_EQ(fit.slope.deviation, 0.0);
  EXPECT_EQ(fit.correlation, 0.0);
}

// NumPy's trapezium rule over 217 x 217 values of the two deviates: the log-likelihood there, whose parabolas
// along each parameter have their tops within these tolerances.
TEST(MixedFit, WithSlopesThatDifferHasTheLargestLikelihood) {
  const MixedFit fit = fit_mixed(answers(), probit(true));
  EXPECT_NEAR(fit.log_likelihood, -489.99708, 5e-4);
  EXPECT_NEAR(fit.threshold.mean, 0.05208, 3e-4);
  EXPECT_NEAR(fit.slope.mean, 7.164, 0.02);
  EXPECT_NEAR(fit.threshold.deviation, 0.09179, 5e-4);
  EXPECT_NEAR(fit.slope.deviation, 0.2961, 0.01);
  EXPECT_LT(fit.threshold.interval().lower, 0.02);
  EXPECT_GT(fit.threshold.interval().upper, 0.02) << "the truth";
  const OfPeople jnd = half_interquartile(fit, Shape::gaussian);
  EXPECT_NEAR(jnd.mean, 0.6744897501960817 / fit.slope.mean, 1e-12);
  EXPECT_NEAR(jnd.interval().lower * fit.slope.interval().upper, 0.6744897501960817, 1e-9);
}

TEST(MixedFit, OfAlikeSubjectsIsNearTheFitOfAllTheirAnswers) {
  Random random(4);
  Subjects subjects;
  std::vector<Level> all;
  for (int subject = 0; subject < 10; ++subject) {
    std::vector<Level>& levels = subjects.emplace_back();
    for (const double level : {0.025, 0.05, 0.1, 0.2, 0.4}) {
      const double p =
          Psychometric{.threshold = 0.1, .slope = 2.0, .guess = 0.5, .lapse = 0.0}.probability(level);
      levels.push_back({.intensity = level, .answers = {.successes = random.successes(30, p), .trials = 30}});
    }
    all.insert(all.end(), levels.begin(), levels.end());
  }
  const MixedFit mixed = fit_mixed(subjects, {.lapse = 0.0});
  const PsychometricFit pooled = fit_psychometric(all, {.lapse = 0.0});
  EXPECT_NEAR(mixed.threshold.mean, pooled.threshold.value, 0.03 * pooled.threshold.value);
  EXPECT_NEAR(mixed.slope.mean, pooled.slope, 0.05 * pooled.slope);
  EXPECT_LT(mixed.threshold.deviation, 0.15);
  EXPECT_TRUE(mixed.threshold.is_ratio);
}

TEST(MixedFit, CountsTheAnswersOfASubjectWhoseOwnCurveHasNoThreshold) {
  Subjects subjects = answers();
  for (Level& level : subjects.front()) level.answers.successes = level.answers.trials;  // all "more"
  const MixedFit fit = fit_mixed(subjects, probit(true));
  EXPECT_TRUE(std::isfinite(fit.threshold.mean));
  EXPECT_GT(fit.threshold.deviation, fit_mixed(answers(), probit(true)).threshold.deviation);
}

TEST(MixedFit, WidensItsIntervalByWhatOtherLapsesWouldSay) {
  Random random(9);
  Subjects subjects;
  for (int subject = 0; subject < 8; ++subject) {
    std::vector<Level>& levels = subjects.emplace_back();
    for (const double level : {-0.4, -0.2, -0.1, 0.1, 0.2, 0.4}) {
      const double p = 0.02 + 0.96 / (1.0 + std::exp(-15.0 * level));
      levels.push_back({.intensity = level, .answers = {.successes = random.successes(12, p), .trials = 12}});
    }
  }
  MixedOptions options = probit(true);
  options.lapse.reset();
  const Interval any = fit_mixed(subjects, options).slope.interval();
  options.lapse = fit_mixed(subjects, options).lapse;
  const Interval known = fit_mixed(subjects, options).slope.interval();
  EXPECT_LE(any.lower, 1.001 * known.lower);
  EXPECT_GE(any.upper, 0.999 * known.upper);
  EXPECT_GT(any.upper / any.lower, 1.02 * known.upper / known.lower);
}

TEST(MixedFit, RefusesWhatSaysNothingOfPeople) {
  const Subjects two(answers().begin(), answers().begin() + 2);
  EXPECT_THROW((void)fit_mixed(two, probit(true)), std::invalid_argument);
  Subjects without = answers();
  without.front().clear();
  EXPECT_THROW((void)fit_mixed(without, probit(true)), std::invalid_argument);
  const std::vector<Level> one{{.intensity = 0.1, .answers = {.successes = 4, .trials = 9}}};
  EXPECT_THROW((void)fit_mixed(Subjects(3, one), probit(true)), std::invalid_argument);
  Subjects all_right = answers();
  for (auto& levels : all_right) {
    for (Level& level : levels) level.answers.successes = level.answers.trials;
  }
  EXPECT_THROW((void)fit_mixed(all_right, probit(true)), std::invalid_argument);
  EXPECT_THROW((void)fit_mixed(answers(), {.axis = Axis::logarithmic}), std::invalid_argument)
      << "levels below 0";
  MixedOptions lapsing = probit(true);
  lapsing.lapse = 0.3;
  EXPECT_THROW((void)fit_mixed(answers(), lapsing), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
