#include "inspect/lag.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bench/data/inspect/blocked.h"

namespace kerf::bench {
namespace {

double wandering(double time_s) { return std::sin(7.0 * time_s) + 0.5 * std::sin(19.0 * time_s + 1.0); }

/// A stiffening spring whose force comes so much later, at 1 kHz.
std::optional<Lag> lag_of(double later_s, double noise = 0.05, std::size_t rows = 20'000) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  std::vector<double> position, force;
  for (std::size_t i = 0; i < rows; ++i) {
    const double time_s = 1e-3 * static_cast<double>(i);
    position.push_back(wandering(time_s));
    force.push_back(std::exp(wandering(time_s - later_s)) + noise * normal(random));
  }
  const std::vector<RowSpan> contacts{{.begin = 0, .end = rows / 3}, {.begin = rows / 2, .end = rows}};
  return lag_between(test::blocked(position), test::blocked(force), contacts, 1e-3);
}

TEST(Lag, IsFoundBetweenRowsWithItsSign) {
  for (const double later_s : {-0.0403, -0.0073, 0.0, 0.0125, 0.06}) {
    const auto lag = lag_of(later_s);
    ASSERT_TRUE(lag) << later_s;
    EXPECT_NEAR(lag->seconds, later_s, 2e-4);
    EXPECT_GT(lag->correlation, 0.9);
    EXPECT_LE(lag->correlation_now, lag->correlation);
  }
}

TEST(Lag, IsNotKnownFromNoise) { EXPECT_FALSE(lag_of(0.01, 10.0)); }

TEST(Lag, IsNotKnownBeyondATenthOfASecond) { EXPECT_FALSE(lag_of(0.13)); }

TEST(Lag, IsNotKnownFromAFewRows) { EXPECT_FALSE(lag_of(0.01, 0.0, 250)); }

}  // namespace
}  // namespace kerf::bench
