#include <cmath>
#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/compare/agreement.h>
#include <kerf/compare/compare.h>
#include <kerf/compare/diagnose.h>

#include "compare/runs.h"

// Rows that are missing in one of two runs, told by their times where the forces are not alike.

namespace kerf::compare {
namespace {

using test::noise;
using test::run_of;
using test::strokes;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Strokes with times, and a sensor's noise.
Series timed(double rough, unsigned seed = 1) {
  Series run = run_of(strokes());
  const std::vector<double> add = noise(run.rows(), rough, seed);
  for (std::size_t row = 0; row < run.rows(); ++row) {
    run.time_s.push_back(1e-3 * static_cast<double>(row));
    run.channels[0].value[row] += add[row];
  }
  return run;
}

Series without(Series run, std::size_t begin, std::size_t end) {
  for (std::vector<double>* column : {&run.time_s, &run.channels[0].value})
    column->erase(column->begin() + static_cast<std::ptrdiff_t>(begin),
                  column->begin() + static_cast<std::ptrdiff_t>(end));
  return run;
}

TEST(MissingRows, AreSeenInTheTimesWhereTheForcesAreNotAlike) {
  const Series expected = timed(0.0);
  const Series got = without(timed(1e-4), 2000, 2300);
  const auto rows = matched_rows(expected, got);
  ASSERT_TRUE(rows);
  EXPECT_TRUE(rows->by_time);
  EXPECT_EQ(rows->expected.size(), 3700U);
  EXPECT_EQ(rows->expected[2000], 2300U);
  EXPECT_EQ(rows->got[2000], 2000U);
  const Comparison comparison = compare_with_gaps(expected, got, {.force_n = 0.01});
  EXPECT_FALSE(comparison.passed);
  EXPECT_EQ(comparison.outside, 0U);
  EXPECT_THAT(comparison.messages,
              ElementsAre("3700 samples where 4000 are stored: 300 lost, by the times at tick 2000"));
  EXPECT_THAT(sentences_of(diagnose(expected, got), expected),
              ElementsAre("300 samples are missing, at tick 2000"));
  const auto backwards = matched_rows(got, expected);
  ASSERT_TRUE(backwards);
  EXPECT_EQ(backwards->expected[2000], 2000U);
  EXPECT_EQ(backwards->got[2000], 2300U);
}

TEST(MissingRows, OfWhichOneIsMissingMakeNoLatency) {
  const Series expected = timed(0.02, 1);
  const Series got = without(timed(0.02, 2), 2000, 2001);
  const auto rows = matched_rows(expected, got);
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->expected[2000], 2001U);
  const ChannelAgreement channel =
      agreement(rows_of(expected, rows->expected), rows_of(got, rows->got)).at(0);
  EXPECT_LT(std::abs(channel.latency_s.value()), 3.0 * channel.latency_std_error_s);
  EXPECT_THAT(sentences_of(diagnose(expected, got), expected), Contains("a sample is missing, at tick 2000"));
}

TEST(MissingRows, AreNamedBesideWhatChangedInTheOthers) {
  const Series expected = timed(0.0);
  Series got = without(timed(1e-4), 2000, 2010);
  for (double& force : got.channels[0].value) force *= 1.3;
  EXPECT_THAT(sentences_of(diagnose(expected, got), expected),
              ElementsAre("10 samples are missing, at tick 2000",
                          AllOf(StartsWith("besides, counted in rows that both have: "), HasSubstr("1.3"))));
}

TEST(MissingRows, AreNoneWhereClocksGoAtOtherRatesOrBeginElsewhere) {
  const Series expected = timed(0.0);
  Series slower = without(timed(1e-4), 3996, 4000);
  for (std::size_t row = 0; row < slower.rows(); ++row) slower.time_s[row] *= 1.001;
  EXPECT_FALSE(matched_rows(expected, slower)) << "no clock steps over a row";
  Series later = without(timed(1e-4), 3900, 4000);
  for (double& time : later.time_s) time += 0.05;
  EXPECT_FALSE(matched_rows(expected, later)) << "row i belongs to row i";
  const auto head = matched_rows(expected, without(timed(1e-4), 0, 100));
  ASSERT_TRUE(head) << "the beginning is missing";
  EXPECT_EQ(head->expected.front(), 100U);
}

}  // namespace
}  // namespace kerf::compare
