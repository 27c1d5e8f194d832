#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/quest_plus.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

QuestPlusOptions usual() {
  return {.intensities = geometric_grid(0.1, 10.0, 41), .thresholds = geometric_grid(0.1, 10.0, 61)};
}

// Two thresholds, one slope, no lapses: everything by hand.
TEST(QuestPlus, UpdatesByBayes) {
  QuestPlus quest(
      {.guess = 0.5, .intensities = {1.0, 2.0}, .thresholds = {1.0, 2.0}, .slopes = {2.0}, .lapses = {0.0}});
  const auto right = [](double x, double threshold) {
    return 1.0 - 0.5 * std::exp(-std::pow(x / threshold, 2.0));
  };
  quest.answer(1.0, true);
  const double a = right(1.0, 1.0);
  const double b = right(1.0, 2.0);
  EXPECT_NEAR(quest.marginal()[0], a / (a + b), 1e-14);
  quest.answer(2.0, false);
  const double c = a * (1.0 - right(2.0, 1.0));
  const double d = b * (1.0 - right(2.0, 2.0));
  EXPECT_NEAR(quest.marginal()[0], c / (c + d), 1e-14);
}

TEST(QuestPlus, AsksWhereTheAnswerTellsMost) {
  // With two candidates the expected entropy can be written down for each intensity.
  const std::vector<double> intensities{0.2, 0.6, 1.0, 1.5, 2.5, 6.0};
  const QuestPlus quest(
      {.guess = 0.5, .intensities = intensities, .thresholds = {1.0, 2.0}, .slopes = {3.0}, .lapses = {0.0}});
  double least = 1.0;
  double best = 0.0;
  for (const double x : intensities) {
    const double a = 1.0 - 0.5 * std::exp(-std::pow(x, 3.0));
    const double b = 1.0 - 0.5 * std::exp(-std::pow(x / 2.0, 3.0));
    const auto entropy = [](double p, double q) {
      const double s = p / (p + q);
      return (p + q) / 2.0 * -(s * std::log(s) + (1.0 - s) * std::log(1.0 - s));
    };
    const double expected = entropy(a, b) + entropy(1.0 - a, 1.0 - b);
    if (expected < least) {
      least = expected;
      best = x;
    }
  }
  EXPECT_EQ(quest.next(), best);
}

TEST(QuestPlus, FindsTheThresholdOfAnObserver) {
  const Psychometric observer{.threshold = 0.7, .slope = 3.0, .guess = 0.5, .lapse = 0.02};
  constexpr int runs = 60;
  double error = 0.0;
  int covered = 0;
  for (int run = 0; run < runs; ++run) {
    Random random(static_cast<std::uint64_t>(run));
    QuestPlus quest(usual());
    while (!quest.finished()) quest.answer(random.chance(observer.probability(quest.next())));
    const QuestPlusEstimate found = quest.estimate();
    error += std::log(found.threshold / 0.7) / runs;
    covered += found.interval.lower <= 0.7 && 0.7 <= found.interval.upper ? 1 : 0;
    EXPECT_EQ(quest.trials(), 60);
    EXPECT_LT(found.deviation, 0.6);
  }
  EXPECT_NEAR(error, 0.0, 0.1);
  EXPECT_GE(covered, 52);
}

TEST(QuestPlus, AsksTheSameAfterTheSameAnswers) {
  QuestPlus first(usual());
  QuestPlus second(usual());
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(first.next(), second.next());
    const bool is_right = random.chance(0.8);
    first.answer(is_right);
    second.answer(is_right);
  }
}

TEST(QuestPlus, EndsWhereTheThresholdIsKnownWellEnough) {
  QuestPlusOptions options = usual();
  options.trials = 1000;
  options.small_deviation = 0.2;
  QuestPlus quest(options);
  Random random(2);
  const Psychometric observer{.threshold = 1.0, .slope = 3.0, .guess = 0.5, .lapse = 0.0};
  while (!quest.finished()) quest.answer(random.chance(observer.probability(quest.next())));
  EXPECT_LT(quest.trials(), 300);
  EXPECT_LT(quest.estimate().deviation, 0.2);
  EXPECT_THROW(quest.answer(true), std::invalid_argument);
}

TEST(QuestPlus, RefusesWhatCannotBe) {
  EXPECT_THROW(QuestPlus({}), std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {2.0, 1.0}, .thresholds = {1.0}}), std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0, 1.0}, .thresholds = {1.0}}), std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0}, .thresholds = {1.0}, .weights_of_thresholds = {0.0}}),
               std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0}, .thresholds = {-1.0}}), std::invalid_argument);
  QuestPlus quest(usual());
  EXPECT_THROW(quest.answer(0.123, true), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
