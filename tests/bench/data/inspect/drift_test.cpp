#include "inspect/drift.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bench/data/inspect/blocked.h"

namespace kerf::bench {
namespace {

/// A force at 1 kHz whose level creeps by 10 mN/s from 0.1 N, and contacts of 3 N every other second.
struct CreepingForce {
  std::vector<double> time_s, force;
  std::vector<RowSpan> contacts;

  CreepingForce() {
    std::mt19937_64 random(8);
    std::normal_distribution<double> noise(0.0, 0.02);
    for (std::size_t i = 0; i < 40'000; ++i) {
      time_s.push_back(1e-3 * static_cast<double>(i));
      force.push_back(0.1 + 0.01 * time_s.back() + noise(random) + (i / 1000 % 2 == 1 ? 3.0 : 0.0));
    }
    for (std::size_t i = 1000; i < 40'000; i += 2000) contacts.push_back({.begin = i, .end = i + 1000});
  }
  [[nodiscard]] std::optional<Drift> drift() const {
    return drift_of(test::blocked(time_s), test::blocked(force), contacts);
  }
};

TEST(Drift, IsThatOfTheLevelBetweenContacts) {
  const auto drift = CreepingForce().drift();
  ASSERT_TRUE(drift);
  EXPECT_NEAR(drift->per_s, 0.01, 2e-4);
  EXPECT_NEAR(drift->over_all, 0.4, 8e-3);
  EXPECT_NEAR(drift->level, 0.3, 0.02) << "half-way";
  EXPECT_LT(drift->scatter, 0.01);
  EXPECT_EQ(drift->windows, 16U);
}

TEST(Drift, IsNotTurnedByAContactThatNobodySaw) {
  CreepingForce creeping;
  creeping.contacts.pop_back();
  creeping.contacts.pop_back();
  const auto drift = creeping.drift();
  ASSERT_TRUE(drift);
  EXPECT_NEAR(drift->per_s, 0.01, 2e-3);  // a line of least squares is off by a factor of three
}

TEST(Drift, IsNotKnownWithoutIdleRows) {
  CreepingForce creeping;
  creeping.contacts = {{.begin = 0, .end = 33'000}};  // three windows are left
  EXPECT_FALSE(creeping.drift());
}

}  // namespace
}  // namespace kerf::bench
