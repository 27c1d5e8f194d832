#include <cmath>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "fitting/strokes.h"
#include "training/held_out.h"
#include "training/trained_memory.h"

namespace kerf::fitting {
namespace {

/// Trains by counting.
struct Counting {
  TrainedMemory memory;
  int trainings = 0;

  Trained ask(const Weights& seen, std::size_t size, double tolerance) {
    return memory.once(seen, size, tolerance, [&] {
      ++trainings;
      Trained law;
      law.solution.values = {{static_cast<double>(trainings)}};
      law.weights = seen;
      for (double& weight : law.weights) weight *= 0.25;
      return law;
    });
  }
};

const Weights without_both{1.0, 1.0, 0.0, 0.0, 0.0, 1.0};
const Weights quarters{0.25, 0.25, 0.0, 0.0, 0.0, 0.25};

TEST(TrainedMemory, TrainsOnceByTheSameSamples) {
  Counting law;
  const Trained first = law.ask(without_both, 2, 1e-8);
  const Trained again = law.ask(without_both, 2, 1e-8);
  EXPECT_EQ(law.trainings, 1);
  EXPECT_EQ(again.solution.values, first.solution.values);
  EXPECT_EQ(first.weights, quarters);
  EXPECT_EQ(again.weights, quarters);
}

TEST(TrainedMemory, TrainsAnewByOtherSamplesASizeMoreOrAnotherTolerance) {
  Counting law;
  (void)law.ask(without_both, 2, 1e-8);
  (void)law.ask({1.0, 1.0, 0.0, 0.0, 0.0, 0.5}, 2, 1e-8);
  (void)law.ask({1.0, 1.0, 0.0, 0.0, 1.0, 1.0}, 2, 1e-8);
  (void)law.ask(without_both, 3, 1e-8);
  (void)law.ask(without_both, 2, 1e-12);
  EXPECT_EQ(law.trainings, 5);
}

TEST(TrainedMemory, TrainsAgainAfterARefusal) {
  Counting law;
  EXPECT_THROW((void)law.memory.once(without_both, 2, 1e-8,
                                     []() -> Trained { throw std::invalid_argument("too few samples"); }),
               std::invalid_argument);
  (void)law.ask(without_both, 2, 1e-8);
  EXPECT_EQ(law.trainings, 1);
}

/// Kelvin's element, and a swing that goes along with no stroke.
Samples swinging_strokes() {
  test::Strokes strokes(8000, 0.01, models::Law::make("kelvin", std::vector{5.0, 8.0, 2.0}));
  for (std::size_t i = 0; i < strokes.force.size(); ++i)
    strokes.force[i] += 0.1 * std::sin(23.0 * strokes.time_s[i]);
  const Series series = strokes.series(true);
  return check_series({&series, 1}, {});
}

TEST(HeldOut, ErrorsAreNeverLessThanWhatTheLawThatWasShownAllLeaves) {
  const Samples samples = swinging_strokes();
  const Weights seen = all_of(samples);
  for (const std::string_view model : {"kelvin", "exponential", "friction"}) {
    const auto train_on = [&](const Weights& shown) { return train(model, {}, samples, shown); };
    const Trained law = train_on(seen);
    const double least =
        least_held_out(residuals_of(law.problem, law.solution.values, samples), samples, seen);
    const HeldOut errors = held_out(train_on, samples, seen, 1);
    EXPECT_EQ(errors.fitted.folds.size(), samples.folds);
    EXPECT_GT(least, 0.0);
    EXPECT_GE(errors.fitted.rmse, least) << model;
  }
}

TEST(TrainGrowing, FitsNoFoldOfASizeThatCannotPay) {
  const Samples samples = swinging_strokes();
  const Weights seen = all_of(samples);
  const Weights fewer = without_fold(samples, seen, 0);
  TrainedMemory memory;
  const Trained law = train("maxwell", {}, samples, seen, of_a_law, &memory);
  EXPECT_EQ(law.problem.parameters.size(), 3U) << "one arm: no further arm goes along with the swing";
  const auto knows = [&](const Weights& shown, std::size_t arms, double tolerance) {
    bool asked = false;
    (void)memory.once(shown, arms, tolerance, [&] {
      asked = true;
      return Trained{};
    });
    return !asked;
  };
  EXPECT_TRUE(knows(seen, 2, of_a_law)) << "two arms were tried";
  EXPECT_TRUE(knows(fewer, 1, of_a_fold));
  EXPECT_FALSE(knows(fewer, 2, of_a_fold));
}

}  // namespace
}  // namespace kerf::fitting
