#include "answers/two_sided_fit.h"

#include <gtest/gtest.h>

#include <kerf/psychophysics/random.h>

namespace kerf::bench {
namespace {

using psychophysics::Level;
using psychophysics::Psychometric;

psychophysics::FitOptions gaussian() {
  return {.shape = psychophysics::Shape::gaussian, .axis = psychophysics::Axis::linear, .guess = 0.0};
}

const Psychometric& observer() {
  static const Psychometric curve{.shape = psychophysics::Shape::gaussian,
                                  .axis = psychophysics::Axis::linear,
                                  .threshold = 0.02,
                                  .slope = 12.5,
                                  .guess = 0.04,
                                  .lapse = 0.04};
  return curve;
}

std::vector<Level> answers(psychophysics::Random& random, int trials) {
  std::vector<Level> levels;
  for (const double at : {-0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2})
    levels.push_back({at, {random.successes(trials, observer().probability(at)), trials}});
  return levels;
}

TEST(EqualLapses, AreFoundWhereTheyAre) {
  std::vector<Level> exact;
  for (const double at : {-0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2}) {
    constexpr int trials = 100'000;
    exact.push_back({at, {static_cast<int>(std::lround(trials * observer().probability(at))), trials}});
  }
  const auto fit = fit_with_equal_lapses(exact, gaussian());
  EXPECT_DOUBLE_EQ(fit.curve.lapse, 0.04);
  EXPECT_DOUBLE_EQ(fit.curve.guess, 0.04);
  EXPECT_NEAR(fit.threshold.value, 0.02, 1e-4);
  EXPECT_NEAR(fit.slope, 12.5, 0.02);
}

TEST(EqualLapses, ThatAreFixedAreKept) {
  psychophysics::Random random(2);
  psychophysics::FitOptions options = gaussian();
  options.lapse = 0.03;
  const auto fit = fit_with_equal_lapses(answers(random, 20), options);
  EXPECT_DOUBLE_EQ(fit.curve.lapse, 0.03);
  EXPECT_DOUBLE_EQ(fit.curve.guess, 0.03);
  EXPECT_DOUBLE_EQ(fit.threshold.criterion, 0.5);
}

TEST(EqualLapses, WidenTheIntervalsOfTheBestLapse) {
  psychophysics::Random random(2);
  const auto levels = answers(random, 20);
  const auto fit = fit_with_equal_lapses(levels, gaussian());
  psychophysics::FitOptions alone = gaussian();
  alone.lapse = fit.curve.lapse;
  const auto narrow = fit_with_equal_lapses(levels, alone);
  EXPECT_LT(fit.slope_interval.lower, narrow.slope_interval.lower + 1e-9);
  EXPECT_GT(fit.slope_interval.upper - fit.slope_interval.lower,
            1.02 * (narrow.slope_interval.upper - narrow.slope_interval.lower));
}

// 60 experiments: below 51 would be under 85 %, which three standard deviations part from 95 %.
TEST(EqualLapses, CoverTheJndAsOftenAsTheySay) {
  psychophysics::Random random(7);
  int covered = 0;
  for (int experiment = 0; experiment < 60; ++experiment) {
    const auto interval =
        psychophysics::half_interquartile(fit_with_equal_lapses(answers(random, 30), gaussian())).interval;
    covered += interval.lower <= 0.6744898 / 12.5 && interval.upper >= 0.6744898 / 12.5 ? 1 : 0;
  }
  EXPECT_GE(covered, 52);
}

}  // namespace
}  // namespace kerf::bench
