#include <array>
#include <cmath>
#include <map>
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

/// A grid of four parameters, each point by itself.
struct Candidate {
  std::array<double, 4> values{};  ///< threshold, slope, guess, lapse
  double weight = 0.0;
};

/// By the definition: of each intensity the posterior after either answer is made, summed over what is a
/// nuisance, and its entropy taken; no step of it is the library's.
double asked_by_definition(const QuestPlusOptions& options, const std::vector<Candidate>& prior,
                           const std::array<bool, 4>& is_nuisance) {
  const auto right = [](const Candidate& at, double x) {
    const auto& [threshold, slope, guess, lapse] = at.values;
    return guess + (1.0 - guess - lapse) * (1.0 - std::exp(-std::pow(x / threshold, slope)));
  };
  double least = HUGE_VAL;
  double asked = 0.0;
  for (const double x : options.intensities) {
    double expected = 0.0;
    for (const bool is_right : {true, false}) {
      std::map<std::array<double, 4>, double> marginal;
      double probability = 0.0;
      for (const Candidate& at : prior) {
        const double joint = at.weight * (is_right ? right(at, x) : 1.0 - right(at, x));
        std::array<double, 4> kept = at.values;
        for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = is_nuisance[i] ? 0.0 : kept[i];
        marginal[kept] += joint;
        probability += joint;
      }
      for (const auto& [kept, joint] : marginal)
        expected -= joint > 0.0 ? joint * std::log(joint / probability) : 0.0;
    }
    if (expected < least - 1e-10) {
      least = expected;
      asked = x;
    }
  }
  return asked;
}

QuestPlusOptions four_grids(const Nuisance& nuisance) {
  return {.intensities = geometric_grid(0.2, 5.0, 17),
          .thresholds = geometric_grid(0.25, 4.0, 9),
          .slopes = {1.0, 2.0, 4.0},
          .lapses = {0.0, 0.03, 0.08},
          .guesses = {0.4, 0.5, 0.6},
          .nuisance = nuisance,
          .trials = 100};
}

/// Answers of chance through both; whatever is asked has to be the same, trial by trial.
void expect_asked_by_definition(const Nuisance& nuisance) {
  const QuestPlusOptions options = four_grids(nuisance);
  std::vector<Candidate> posterior;
  for (const double threshold : options.thresholds)
    for (const double slope : options.slopes)
      for (const double guess : options.guesses)
        for (const double lapse : options.lapses)
          posterior.push_back({.values = {threshold, slope, guess, lapse}, .weight = 1.0 / 243.0});
  QuestPlus quest(options);
  Random random(7);
  for (int trial = 0; trial < 25; ++trial) {
    const double x = quest.next();
    ASSERT_EQ(
        x, asked_by_definition(options, posterior, {false, nuisance.slope, nuisance.guess, nuisance.lapse}))
        << "trial " << trial;
    const bool is_right = random.chance(x > 1.0 ? 0.9 : 0.55);
    double sum = 0.0;
    for (Candidate& at : posterior) {
      const auto& [threshold, slope, guess, lapse] = at.values;
      const double p = guess + (1.0 - guess - lapse) * (1.0 - std::exp(-std::pow(x / threshold, slope)));
      at.weight *= is_right ? p : 1.0 - p;
      sum += at.weight;
    }
    for (Candidate& at : posterior) at.weight /= sum;
    quest.answer(is_right);
  }
  double guess = 0.0;
  double lapse = 0.0;
  double log_slope = 0.0;
  for (const Candidate& at : posterior) {
    log_slope += at.weight * std::log(at.values[1]);
    guess += at.weight * at.values[2];
    lapse += at.weight * at.values[3];
  }
  EXPECT_NEAR(quest.estimate().slope, std::exp(log_slope), 1e-12);
  EXPECT_NEAR(quest.estimate().guess, guess, 1e-12);
  EXPECT_NEAR(quest.estimate().lapse, lapse, 1e-12);
}

TEST(QuestPlus, AsksByTheEntropyOfAllFourParameters) { expect_asked_by_definition({}); }

TEST(QuestPlus, AsksByTheEntropyOfWhatIsNoNuisance) {
  expect_asked_by_definition({.lapse = true});
  expect_asked_by_definition({.slope = true, .lapse = true});
  expect_asked_by_definition({.slope = true, .guess = true, .lapse = true});
}

// [Prins2013]: a trial goes to a nuisance only where that tells of the threshold, which is known better for
// it.
TEST(QuestPlus, KnowsTheThresholdBetterWhereTheRestIsANuisance) {
  const auto mean_deviation = [](const Nuisance& nuisance) {
    constexpr int runs = 30;
    double sum = 0.0;
    for (int run = 0; run < runs; ++run) {
      QuestPlus quest({.intensities = geometric_grid(0.1, 10.0, 33),
                       .thresholds = geometric_grid(0.1, 10.0, 41),
                       .lapses = {0.0, 0.03, 0.06, 0.09},
                       .nuisance = nuisance,
                       .trials = 60});
      const Psychometric observer{.threshold = 0.7, .slope = 3.0, .guess = 0.5, .lapse = 0.03};
      Random random(static_cast<std::uint64_t>(run));
      while (!quest.finished()) quest.answer(random.chance(observer.probability(quest.next())));
      sum += quest.estimate().deviation / runs;
    }
    return sum;
  };
  EXPECT_LT(mean_deviation({.slope = true, .lapse = true}), 0.95 * mean_deviation({}));
}

TEST(QuestPlus, EndsWhereTheIntervalIsNarrow) {
  QuestPlusOptions options = usual();
  options.trials = 1000;
  options.narrow = 2.0;
  options.least_trials = 15;
  const Psychometric observer{.threshold = 1.0, .slope = 3.0, .guess = 0.5, .lapse = 0.0};
  const auto trials_of = [&](std::uint64_t seed) {
    QuestPlus quest(options);
    Random random(seed);
    while (!quest.finished()) {
      const Interval before = quest.estimate(options.narrow_confidence).interval;
      if (quest.trials() >= options.least_trials) {
        EXPECT_GT(before.upper / before.lower, 2.0);
      }
      quest.answer(random.chance(observer.probability(quest.next())));
    }
    const Interval interval = quest.estimate().interval;
    if (quest.trials() < options.trials) {
      EXPECT_LE(interval.upper / interval.lower, 2.0);
    }
    return quest.trials();
  };
  const int trials = trials_of(2);
  EXPECT_GT(trials, 15);
  EXPECT_LT(trials, 300);
  options.least_trials = 400;
  EXPECT_EQ(trials_of(2), 400);
  options.trials = 20;
  EXPECT_EQ(trials_of(2), 20) << "the most there are";
}

TEST(QuestPlus, RefusesWhatCannotBe) {
  EXPECT_THROW(QuestPlus({}), std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {2.0, 1.0}, .thresholds = {1.0}}), std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0, 1.0}, .thresholds = {1.0}}), std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0}, .thresholds = {1.0}, .weights_of_thresholds = {0.0}}),
               std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0}, .thresholds = {-1.0}}), std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0}, .thresholds = {1.0}, .guesses = {0.5, 0.4}}),
               std::invalid_argument);
  EXPECT_THROW(QuestPlus({.intensities = {1.0}, .thresholds = {1.0}, .narrow = -1.0}), std::invalid_argument);
  QuestPlus quest(usual());
  EXPECT_THROW(quest.answer(0.123, true), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
