#include "probe/push_judgement.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr double step_m = 50e-6;

drivers::DeviceInfo three_axes() {
  drivers::DeviceInfo device;
  for (const char* name : {"x", "y", "z"}) {
    device.axes.push_back({.name = name, .position_unit = "m", .force_unit = "N", .resolution = step_m});
  }
  device.axes.push_back({.name = "rx", .position_unit = "rad", .force_unit = "N·m", .resolution = 1e-3});
  return device;
}

/// A handle of which everything is known: it moves so far along an axis for a push along x.
struct Handle {
  double along_x_m = 0.0;
  double along_y_m = 0.0;
  double noise_m = 0.0;         ///< of the hand, white
  double drift_m = 0.0;         ///< the same in each push, whichever way
  double drift_change_m = 0.0;  ///< and what it grows by from push to push
};

std::vector<Push> pushes_on(const Handle& handle, std::size_t pairs, unsigned seed = 1) {
  constexpr std::array order{1.0, -1.0, -1.0, 1.0};
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Push> pushes;
  for (std::size_t i = 0; i < 2 * pairs; ++i) {
    Push push{.direction = order[i % 4]};
    const double drift = handle.drift_m + handle.drift_change_m * static_cast<double>(i);
    push.moved[0] = push.direction * handle.along_x_m + drift + handle.noise_m * noise(random);
    push.moved[1] = push.direction * handle.along_y_m + drift + handle.noise_m * noise(random);
    push.moved[2] = drift + handle.noise_m * noise(random);
    push.moved[3] = push.direction * 0.5 + 0.01 * noise(random);
    pushes.push_back(push);
  }
  return pushes;
}

PushJudgement judged(const Handle& handle, std::size_t pairs = 8) {
  return judge_pushes(pushes_on(handle, pairs), three_axes(), 0);
}

TEST(PushJudgement, IsRightWhereTheHandleFollowsAndWrongWhereItComesBack) {
  EXPECT_EQ(judged({.along_x_m = 2e-3, .noise_m = 1e-4}).verdict, PushVerdict::right);
  EXPECT_EQ(judged({.along_x_m = -2e-3, .noise_m = 1e-4}).verdict, PushVerdict::wrong);
}

TEST(PushJudgement, ADriftIsNoAnswer) {
  // Ten times what a push does.
  EXPECT_EQ(judged({.drift_m = 20e-3, .drift_change_m = 1e-3}).verdict, PushVerdict::unknown);
  const PushJudgement moved = judged({.along_x_m = -2e-3, .drift_m = 20e-3, .drift_change_m = 1e-4});
  EXPECT_EQ(moved.verdict, PushVerdict::wrong);
  EXPECT_NEAR(moved.moved, -2e-3, 1e-12);
}

TEST(PushJudgement, AHandThatHoldsFirmlyLeavesItUnknown) {
  EXPECT_EQ(judged({.along_x_m = 0.4 * step_m}).verdict, PushVerdict::unknown);
  EXPECT_EQ(judged({.along_x_m = 0.6 * step_m}).verdict, PushVerdict::right);
  EXPECT_EQ(judged({.along_x_m = 2e-4, .noise_m = 5e-3}).verdict, PushVerdict::unknown);
}

TEST(PushJudgement, AnotherAxisThatMovesInsteadIsWrong) {
  const PushJudgement judgement = judged({.along_y_m = 2e-3, .noise_m = 1e-5});
  EXPECT_EQ(judgement.verdict, PushVerdict::wrong);
  EXPECT_EQ(judgement.instead, 1U);
  EXPECT_EQ(judged({.along_x_m = 1e-3, .along_y_m = 5e-3, .noise_m = 1e-5}).verdict, PushVerdict::right)
      << "a mechanism may couple its axes";
  EXPECT_EQ(judged({.noise_m = 1e-5}).verdict, PushVerdict::unknown) << "a rotation is no distance";
}

TEST(PushJudgement, TakesThreePairsAtLeast) {
  EXPECT_EQ(judged({.along_x_m = 2e-3}, 2).verdict, PushVerdict::unknown);
  EXPECT_EQ(judged({.along_x_m = 2e-3}, 3).verdict, PushVerdict::right);
  EXPECT_EQ(judged({.along_x_m = 2e-3}, 1).moved, 0.0) << "nor has it moved that anybody knows";
}

// By Student's table: t(5) at 99.9 % on both sides is 6.869.
TEST(PushJudgement, TellsTheIntervalOfItsPairs) {
  std::vector<Push> pushes;
  for (const double moved : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    for (const double direction : {1.0, -1.0}) {
      pushes.push_back({.direction = direction, .moved = {1e-3 * direction * moved}});
    }
  }
  const PushJudgement judgement = judge_pushes(pushes, three_axes(), 0);
  EXPECT_NEAR(judgement.moved, 3.5e-3, 1e-15);
  EXPECT_NEAR(judgement.uncertainty, 6.869e-3 * std::sqrt(3.5 / 6.0), 1e-6);
}

// Where nothing moves, whoever looks after each pair is misled more often than by one look: how often, is
// counted.
TEST(PushJudgement, NoiseIsSeldomTakenForAnAnswer) {
  constexpr int hands = 2000;
  int misled = 0;
  for (unsigned seed = 1; seed <= hands; ++seed) {
    const auto pushes = pushes_on({.noise_m = 1e-3, .drift_m = 3e-3}, most_push_pairs, seed);
    for (std::size_t pairs = least_push_pairs; pairs <= most_push_pairs; ++pairs) {
      const auto judgement = judge_pushes(std::span(pushes).first(2 * pairs), three_axes(), 0);
      if (judgement.verdict == PushVerdict::unknown) continue;
      ++misled;
      break;
    }
  }
  EXPECT_LE(misled, hands / 100);
}

}  // namespace
}  // namespace kerf::bench
