#include "recordings/contact_rows.h"

#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bench/data/inspect/blocked.h"

namespace kerf::bench {
namespace {

AxisSeries idle_series(std::size_t rows, double period_s) {
  AxisSeries series;
  for (std::size_t i = 0; i < rows; ++i) series.time_s.push_back(period_s * static_cast<double>(i));
  series.penetration.assign(rows, 0.0);
  series.velocity.assign(rows, 0.0);
  series.force.assign(rows, 0.0);
  return series;
}

TEST(ContactRows, AreThoseOfAForceWithItsMarginsAndShortGaps) {
  AxisSeries series = idle_series(10000, 1e-3);
  const auto push = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) series.force[i] = 1.0;
  };
  push(2000, 3000);
  push(3400, 4000);  // gave way for 0.4 s
  push(6000, 7000);
  const std::size_t counted = mark_contact(series, 0.05);
  EXPECT_EQ(counted, static_cast<std::size_t>(std::reduce(series.counts.begin(), series.counts.end(), 0)));
  const auto counts = [&](std::size_t row) { return series.counts[row] != 0; };
  EXPECT_FALSE(counts(1890));
  EXPECT_TRUE(counts(1905) && counts(2500) && counts(3200) && counts(4090));
  EXPECT_FALSE(counts(4110) || counts(5000) || counts(5890) || counts(7110));
  EXPECT_TRUE(counts(5905) && counts(7090));
}

TEST(ContactRows, AreNotMadeByNoise) {
  AxisSeries series = idle_series(10000, 1e-3);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.1);  // twice what a hand feels
  for (double& force : series.force) force = noise(random);
  for (std::size_t i = 5000; i < 6000; ++i) series.force[i] += 2.0;
  const std::size_t counted = mark_contact(series, 0.05);
  EXPECT_GE(counted, 1200U);
  EXPECT_LT(counted, 2500U) << "a row in 16,000 is beyond four standard deviations";
}

TEST(ContactRows, AreAllWhereNoForceIsFelt) {
  AxisSeries series = idle_series(1000, 1e-3);
  EXPECT_EQ(mark_contact(series, 0.05), 1000U);
  EXPECT_TRUE(series.counts.empty());
}

TEST(ContactRows, AreTheSameSeenByBlocks) {
  AxisSeries series = idle_series(200'000, 1e-3);  // four blocks
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (std::size_t i = 0; i < series.force.size(); ++i)
    series.force[i] = noise(random) + (i / 7000 % 3 == 1 ? 1.0 : 0.0);
  const ContactRows found = contact_rows(test::blocked(series.time_s), test::blocked(series.force), 0.05);
  EXPECT_EQ(found.rows, mark_contact(series, 0.05));
  std::vector<std::uint8_t> counts(series.counts.size(), 0);
  for (const RowSpan& span : found.spans)
    for (std::size_t row = span.begin; row < span.end; ++row) counts[row] = 1;
  EXPECT_EQ(counts, series.counts);
}

}  // namespace
}  // namespace kerf::bench
