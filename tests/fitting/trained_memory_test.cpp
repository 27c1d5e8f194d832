#include "training/trained_memory.h"

#include <stdexcept>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace kerf::fitting
