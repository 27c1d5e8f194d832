#include "signal/signal.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

std::vector<double> sampled(std::size_t count, double rate_hz, const auto& function) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(function(static_cast<double>(i) / rate_hz));
  return values;
}

TEST(LowPass, HalvesASineAtItsCornerWithoutPhase) {
  const auto sine = sampled(4000, 1000.0, [](double t) { return std::sin(two_pi * 10.0 * t); });
  const auto filtered = low_pass_zero_phase(sine, 1000.0, 10.0);
  for (std::size_t i = 1000; i < 3000; ++i) ASSERT_NEAR(filtered[i], 0.5 * sine[i], 1e-6);
}

TEST(LowPass, PassesWhatIsSlowAndStopsWhatIsFast) {
  const auto slow = sampled(4000, 1000.0, [](double t) { return std::sin(two_pi * 0.5 * t); });
  const auto fast = sampled(4000, 1000.0, [](double t) { return std::sin(two_pi * 200.0 * t); });
  const auto filtered_slow = low_pass_zero_phase(slow, 1000.0, 10.0);
  const auto filtered_fast = low_pass_zero_phase(fast, 1000.0, 10.0);
  for (std::size_t i = 1000; i < 3000; ++i) {
    ASSERT_NEAR(filtered_slow[i], slow[i], 1e-5);
    ASSERT_NEAR(filtered_fast[i], 0.0, 1e-5);
  }
}

TEST(LowPass, LeavesALineAloneToItsEnds) {
  const auto line = sampled(500, 333.0, [](double t) { return 3.0 - 2.0 * t; });
  EXPECT_THAT(low_pass_zero_phase(line, 333.0, 20.0), testing::Pointwise(testing::DoubleNear(1e-9), line));
}

TEST(LowPass, RefusesACornerAboveHalfTheRate) {
  const std::vector<double> values(10, 1.0);
  EXPECT_THROW((void)low_pass_zero_phase(values, 100.0, 50.0), std::invalid_argument);
  EXPECT_THROW((void)low_pass_zero_phase(values, 100.0, 0.0), std::invalid_argument);
}

TEST(Derivative, IsExactOnParabolasAtAnyTimes) {
  std::vector<double> time;
  std::vector<double> value;
  for (int i = 0; i < 200; ++i) {
    time.push_back(0.003 * i + 0.001 * std::sin(12.9 * i));
    value.push_back(1.0 - 2.0 * time.back() + 5.0 * time.back() * time.back());
  }
  const auto slope = differentiate(time, value, 0.04);
  for (std::size_t i = 0; i < time.size(); ++i) ASSERT_NEAR(slope[i], -2.0 + 10.0 * time[i], 1e-8) << i;
}

TEST(Derivative, IsTheSameAtUniformTimesAsAtAnyOthers) {
  const auto time = sampled(300, 1000.0, [](double t) { return t; });
  const auto value =
      sampled(300, 1000.0, [](double t) { return std::sin(30.0 * t) + 0.01 * std::cos(2000.0 * t); });
  auto shifted = time;
  shifted.back() += 1e-6;  // no longer uniform: the general way
  const auto uniform = differentiate(time, value, 0.02);
  const auto general = differentiate(shifted, value, 0.02);
  for (std::size_t i = 0; i < 280; ++i) ASSERT_NEAR(uniform[i], general[i], 1e-9) << i;
}

TEST(Derivative, StillHasNeighboursAcrossAGap) {
  const std::vector<double> time{0.0, 0.001, 1.0, 2.0, 2.001};
  const std::vector<double> value{0.0, 0.002, 2.0, 4.0, 4.002};
  EXPECT_THAT(differentiate(time, value, 0.01), testing::Each(testing::DoubleNear(2.0, 1e-9)));
  EXPECT_THAT(differentiate(std::vector{1.0}, std::vector{7.0}, 0.01), testing::ElementsAre(0.0));
}

TEST(Interpolation, IsLinearInsideAndHoldsOutside) {
  const std::vector<double> time{0.0, 1.0, 3.0};
  const std::vector<double> value{0.0, 10.0, 0.0};
  EXPECT_THAT(interpolate(time, value, std::vector{-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0}),
              testing::ElementsAre(0.0, 0.0, 5.0, 10.0, 5.0, 0.0, 0.0));
}

}  // namespace
}  // namespace kerf::bench
