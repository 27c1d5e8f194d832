#include "inspect/signal_facts.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bench/data/inspect/blocked.h"

namespace kerf::bench {
namespace {

using test::blocked;

/// A slow wave of 50 units that a sensor with noise gives in whole units.
std::vector<double> rounded_wave(double noise, std::size_t rows = 20'000, double unit = 1.0) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<double> values;
  for (std::size_t i = 0; i < rows; ++i)
    values.push_back(unit * std::round(50.0 * std::sin(1e-3 * static_cast<double>(i)) + normal(random)));
  return values;
}

TEST(SignalFacts, KnowASensorThatIsReadMoreOftenThanItMeasures) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<double> held;
  std::vector<double> measured;
  double value = 0.0;
  for (int row = 0; row < 20'000; ++row) {
    const double now = std::sin(1e-3 * row) + noise(random);
    if (row % 10 == 0) value = now;
    held.push_back(value);
    measured.push_back(now);
  }
  EXPECT_EQ(signal_facts(blocked(held)).held_rows, std::optional<std::size_t>(10));
  EXPECT_EQ(signal_facts(blocked(measured)).held_rows, std::nullopt);
}

TEST(SignalFacts, TakeNoEncoderThatCreepsForASensorThatIsHeld) {
  std::vector<double> creeping;  // a motor at one speed, a count every four rows
  for (int row = 0; row < 20'000; ++row) creeping.push_back(1e-6 * std::floor(0.25 * row));
  EXPECT_EQ(signal_facts(blocked(creeping)).held_rows, std::nullopt);
  EXPECT_EQ(signal_facts(blocked(rounded_wave(0.3))).held_rows, std::nullopt);
  EXPECT_EQ(signal_facts(blocked(std::vector<double>(20'000, 1.0))).held_rows, std::nullopt);
}

TEST(SignalFacts, KnowTheStepOfASensorThatRounds) {
  const auto values = rounded_wave(0.7, 20'000, 0.0072);
  EXPECT_NEAR(quantum_of(blocked(values)).value(), 0.0072, 1e-12);
}

TEST(SignalFacts, TakeNoRampForASensorThatRounds) {
  std::vector<double> ramp;
  for (std::size_t i = 0; i < 500; ++i) ramp.push_back(0.001 * static_cast<double>(i));
  ramp.resize(20'000, ramp.back());  // and stands
  EXPECT_EQ(quantum_of(blocked(ramp)), std::nullopt);
}

TEST(SignalFacts, HaveNoQuantumWhereNoValueComesAgain) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> values(300'000);
  for (double& value : values) value = normal(random);
  EXPECT_EQ(quantum_of(blocked(values)), std::nullopt);
}

// Rounding to a step adds its twelfth, squared, to the variance of the noise.
TEST(SignalFacts, TellNoiseAndRoundingTogether) {
  for (const double noise : {0.5, 0.8, 1.3, 3.0}) {
    const auto values = rounded_wave(noise);
    const double both = std::sqrt(noise * noise + 1.0 / 12.0);
    EXPECT_NEAR(noise_of(blocked(values), quantum_of(blocked(values))).value(), both, 0.06 * both) << noise;
  }
  // A sensor whose noise moves it over no step shows none: what is left is its rounding.
  const auto quiet = rounded_wave(0.1);
  EXPECT_NEAR(noise_of(blocked(quiet), 1.0).value(), 1.0 / std::sqrt(12.0), 1e-12);
}

TEST(SignalFacts, TellTheNoiseOfRowsInAndOutsideOfSpans) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> values(40'000);
  const std::vector<RowSpan> spans{{.begin = 5'000, .end = 15'000}, {.begin = 20'000, .end = 30'000}};
  InSpans in_spans(spans);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = normal(random) * (in_spans(i) ? 0.3 : 0.1);
  EXPECT_NEAR(noise_of(blocked(values), {}, {.spans = spans, .inside = true}).value(), 0.3, 0.012);
  EXPECT_NEAR(noise_of(blocked(values), {}, {.spans = spans}).value(), 0.1, 0.004);
  EXPECT_EQ(noise_of(blocked(values), {}, {.spans = {}, .inside = true}), std::nullopt);
}

TEST(SignalFacts, TakeTheNoiseOfASensorThatIsClippedMostOfTheTime) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0.0, 0.1);
  std::vector<double> values(20'000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 10'000 < 7'000 ? 1.0 : normal(random);
  EXPECT_NEAR(noise_of(blocked(values), std::nullopt).value(), 0.1, 0.005);
}

TEST(SignalFacts, AreThoseOfAllRowsHoweverMany) {
  const auto values = rounded_wave(0.8, 1'100'000);  // more than are kept in memory
  const double both = std::sqrt(0.64 + 1.0 / 12.0);
  EXPECT_NEAR(noise_of(blocked(values), 1.0).value(), both, 0.03 * both);
}

TEST(SignalFacts, SeeASensorThatIsBlindAtZero) {
  std::vector<double> from_zero_on = rounded_wave(0.7);
  for (double& value : from_zero_on) value = std::max(value, 0.0);
  const SignalFacts facts = signal_facts(blocked(from_zero_on));
  EXPECT_GT(facts.zeros, 9'000U);
  EXPECT_EQ(facts.nearest_zero, 1.0);
  EXPECT_TRUE(facts.is_blind_at_zero());
  std::vector<double> about_zero = rounded_wave(0.7);
  for (double& value : about_zero) value = std::abs(value) < 5.0 ? 0.0 : value;
  EXPECT_TRUE(signal_facts(blocked(about_zero)).is_blind_at_zero());
}

TEST(SignalFacts, SeeNoBlindnessInASensorThatRounds) {
  std::vector<double> values = rounded_wave(0.7);
  for (double& value : values) value = std::round(0.1 * value);
  const SignalFacts facts = signal_facts(blocked(values));
  EXPECT_GT(facts.zeros, 1'000U) << "of eleven levels";
  EXPECT_FALSE(facts.is_blind_at_zero());
}

TEST(SignalFacts, FindSingleRowsThatStandOut) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal(0.0, 0.01);
  std::vector<double> values;
  for (std::size_t i = 0; i < 150'000; ++i)
    values.push_back(std::sin(2e-3 * static_cast<double>(i)) + normal(random));
  values[777] += 0.5;
  values[65'535] -= 2.0;  // at the seam of two blocks
  values[90'000] += 1.0;
  values[90'001] += 1.0;  // two rows are no single one
  SignalFacts facts = signal_facts(blocked(values));
  find_outliers(facts, blocked(values), facts.noise.value());
  ASSERT_EQ(facts.outliers, 2U);
  EXPECT_EQ(facts.largest_outliers[0].row, 65'535U);
  EXPECT_NEAR(facts.largest_outliers[0].height, 2.0, 0.05);
  EXPECT_EQ(facts.largest_outliers[1].row, 777U);
}

TEST(SignalFacts, KeepTheLargestOfManyRowsThatStandOut) {
  std::vector<double> values(3'000, 0.0);
  for (std::size_t i = 10; i < values.size(); i += 10) values[i] = static_cast<double>(i);
  SignalFacts facts;
  find_outliers(facts, blocked(values), 1e-3);
  EXPECT_EQ(facts.outliers, 299U);
  ASSERT_EQ(facts.largest_outliers.size(), SignalFacts::most_outliers);
  EXPECT_EQ(facts.largest_outliers.front().row, 2'990U);
  EXPECT_EQ(facts.largest_outliers.back().row, 2'800U);
  values[500] = std::numeric_limits<double>::infinity();
  find_outliers(facts = {}, blocked(values), 1e-3);
  EXPECT_EQ(facts.outliers, 298U) << "what is not finite is counted elsewhere";
  find_outliers(facts = {}, blocked(values), 0.0);
  EXPECT_EQ(facts.outliers, std::nullopt) << "without a noise nobody knows";
}

}  // namespace
}  // namespace kerf::bench
