#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/psychophysics/random.h>
#include <kerf/psychophysics/staircase.h>

namespace kerf::psychophysics {
namespace {

// Levitt [Levitt1971], table I.
TEST(Staircase, SettlesWhereLevittSays) {
  EXPECT_NEAR(convergence_point(1, 1), 0.5, 1e-12);
  EXPECT_NEAR(convergence_point(1, 2), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(convergence_point(1, 3), std::cbrt(0.5), 1e-12);
  EXPECT_NEAR(convergence_point(1, 4), std::pow(0.5, 0.25), 1e-12);
  EXPECT_NEAR(convergence_point(2, 1), 1.0 - std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(convergence_point(3, 3), 0.5, 1e-12);
}

TEST(Staircase, SettlesElsewhereWithUnequalSteps) {
  // Kaernbach [Kaernbach1991]: one up by three, one down by one settles at 75 %.
  EXPECT_NEAR(convergence_point(1, 1, 1.0 / 3.0), 0.75, 1e-12);
}

TEST(Staircase, GoesDownAfterSoManyRightAnswersAndUpAfterAWrongOne) {
  Staircase stairs({.start = 10.0, .steps = {2.0, 1.0}, .axis = Axis::linear, .reversals = 4, .dropped = 0});
  const auto answer = [&](bool is_right) {
    stairs.answer(is_right);
    return stairs.next();
  };
  EXPECT_EQ(answer(true), 10.0);
  EXPECT_EQ(answer(true), 8.0);
  EXPECT_EQ(answer(true), 8.0);
  EXPECT_EQ(answer(false), 9.0);  // turns at 8, and the step becomes 1
  EXPECT_EQ(answer(true), 9.0);
  EXPECT_EQ(answer(true), 8.0);   // turns at 9
  EXPECT_EQ(answer(false), 9.0);  // turns at 8
  EXPECT_FALSE(stairs.finished());
  answer(true);
  answer(true);  // turns at 9
  EXPECT_TRUE(stairs.finished());
  EXPECT_EQ(stairs.reversals(), (std::vector<double>{8.0, 9.0, 8.0, 9.0}));
  EXPECT_EQ(stairs.estimate().threshold, 8.5);
  EXPECT_EQ(stairs.estimate().standard_error, 0.0);
  EXPECT_EQ(stairs.trials(), 9);
  EXPECT_THROW(stairs.answer(true), std::invalid_argument);
}

TEST(Staircase, StaysWithinItsBounds) {
  Staircase stairs({.start = 1.0, .steps = {1.0}, .least = 0.5, .most = 2.0, .max_trials = 20});
  for (int i = 0; i < 10; ++i) {
    stairs.answer(true);
    EXPECT_GE(stairs.next(), 0.5);
  }
  for (int i = 0; i < 10; ++i) {
    stairs.answer(false);
    EXPECT_LE(stairs.next(), 2.0);
  }
  EXPECT_TRUE(stairs.finished());
}

TEST(Staircase, FindsTheThresholdOfAnObserverAtItsCriterion) {
  const Psychometric observer{.threshold = 1.0, .slope = 2.5, .guess = 0.5, .lapse = 0.0};
  for (const int down : {2, 3}) {
    Random random(4);
    double sum = 0.0;
    double probability = 0.0;
    constexpr int runs = 300;
    for (int run = 0; run < runs; ++run) {
      Staircase stairs({.down = down,
                        .start = 3.0,
                        .steps = {0.3, 0.1, 0.05},
                        .reversals = 30,
                        .dropped = 6,
                        .max_trials = 2000});
      while (!stairs.finished()) stairs.answer(random.chance(observer.probability(stairs.next())));
      sum += std::log(stairs.estimate().threshold) / runs;
      probability = stairs.estimate().probability;
    }
    EXPECT_NEAR(std::exp(sum), observer.intensity_at(probability), 0.05 * observer.intensity_at(probability));
  }
}

TEST(Staircase, RefusesWhatCannotBe) {
  EXPECT_THROW(Staircase({.start = 0.0}), std::invalid_argument);
  EXPECT_THROW(Staircase({.steps = {}}), std::invalid_argument);
  EXPECT_THROW(Staircase({.steps = {0.0}}), std::invalid_argument);
  EXPECT_THROW(Staircase({.down = 0}), std::invalid_argument);
  EXPECT_THROW(Staircase({.reversals = 4, .dropped = 3}), std::invalid_argument);
  EXPECT_THROW((void)Staircase({}).estimate(), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
