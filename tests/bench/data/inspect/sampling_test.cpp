#include "inspect/sampling.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

#include "recordings/row_figures.h"

namespace kerf::bench {
namespace {

schema::Recording rows_at(const std::vector<double>& time_s) {
  schema::Recording recording;
  recording.axes = {{}};
  recording.time = time_s;
  for (std::size_t i = 0; i < time_s.size(); ++i) recording.tick.push_back(i);
  recording.position.assign(time_s.size(), 0.0);
  recording.velocity = recording.position;
  return recording;
}

TEST(Sampling, KnowsTheTrueRateOfAClockOfWholeMilliseconds) {
  std::vector<double> time_s;
  for (std::size_t i = 0; i < 100'000; ++i)
    time_s.push_back(1e-3 * std::floor(2.68 * static_cast<double>(i)));  // 373.1 Hz
  const auto recording = rows_at(time_s);
  const Sampling sampling = sampling_of(schema::RowsInMemory(recording));
  EXPECT_NEAR(sampling.period_s, 0.003, 1e-9) << "the usual step is another";
  EXPECT_NEAR(sampling.true_rate_hz.value(), 1e3 / 2.68, 1e-3);
  EXPECT_NEAR(sampling.resolution_s.value(), 1e-3, 1e-9);
  EXPECT_NEAR(sampling.jitter_s.value(), 1e-3 * std::sqrt(0.68 * 0.32), 1e-6) << "steps of 3 ms in 68 of 100";
  EXPECT_NEAR(sampling.shortest_s.value(), 0.002, 1e-9);
  EXPECT_NEAR(sampling.longest_s.value(), 0.003, 1e-9);
  EXPECT_EQ(sampling.gaps, 0U);
}

TEST(Sampling, KnowsJitterAndNoResolutionOfAClockWithoutSteps) {
  std::mt19937_64 random(10);
  std::normal_distribution<double> normal(0.0, 2e-5);
  std::vector<double> time_s;
  for (std::size_t i = 0; i < 50'000; ++i) time_s.push_back(1e-3 * static_cast<double>(i) + normal(random));
  const auto recording = rows_at(time_s);
  const Sampling sampling = sampling_of(schema::RowsInMemory(recording));
  EXPECT_NEAR(sampling.jitter_s.value(), 2e-5 * std::sqrt(2.0), 5e-7) << "of a step: two times";
  EXPECT_NEAR(sampling.true_rate_hz.value(), 1000.0, 0.01);
  EXPECT_EQ(sampling.resolution_s, std::nullopt);
}

TEST(Sampling, CountsGapsAsASummaryDoesAndKeepsThemOutOfTheRate) {
  std::vector<double> time_s;
  for (std::size_t i = 0; i < 10'000; ++i)
    time_s.push_back(1e-3 * static_cast<double>(i) + (i < 700 ? 0.0 : 5.0));
  auto recording = rows_at(time_s);
  for (std::size_t i = 8'000; i < recording.tick.size(); ++i) recording.tick[i] += 4;
  recording.time[9'000] = recording.time[8'999];
  const schema::RowsInMemory rows(recording);
  const Sampling sampling = sampling_of(rows);
  const RowFigures figures = figures_of(rows);
  EXPECT_EQ(sampling.gaps, 2U);
  EXPECT_EQ(sampling.gaps, figures.gaps);
  EXPECT_EQ(sampling.repeated, 1U);
  EXPECT_EQ(sampling.repeated, figures.repeated);
  EXPECT_EQ(sampling.first_gaps[0].row, 700U);
  EXPECT_NEAR(sampling.first_gaps[0].seconds, 5.001, 1e-9);
  EXPECT_EQ(sampling.first_gaps[0].missing_ticks, 0U);
  EXPECT_EQ(sampling.first_gaps[1].row, 8'000U);
  EXPECT_EQ(sampling.first_gaps[1].missing_ticks, 4U);
  EXPECT_NEAR(sampling.true_rate_hz.value(), 1000.0, 0.5);
}

TEST(Sampling, OfOneRowKnowsNothingBut1Row) {
  const auto recording = rows_at({0.0});
  const Sampling sampling = sampling_of(schema::RowsInMemory(recording));
  EXPECT_EQ(sampling.rows, 1U);
  EXPECT_EQ(sampling.true_rate_hz, std::nullopt);
  EXPECT_EQ(sampling.jitter_s, std::nullopt);
}

}  // namespace
}  // namespace kerf::bench
