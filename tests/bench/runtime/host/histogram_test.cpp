#include "host/histogram.h"

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(Histogram, KnowsPercentilesWithinThreePercent) {
  Histogram histogram;
  for (std::int64_t value = 1; value <= 100'000; ++value) histogram.add(value);
  for (const double share : {0.5, 0.99, 0.999}) {
    EXPECT_NEAR(histogram.percentile_ns(share) / (share * 1e5), 1.0, 0.032) << share;
  }
  EXPECT_EQ(histogram.max_ns(), 1e5);
  EXPECT_EQ(histogram.percentile_ns(1.0), 1e5);
  EXPECT_EQ(histogram.mean_ns(), 50'000.5);
  EXPECT_EQ(histogram.count(), 100'000U);
}

TEST(Histogram, CountsEachDurationInTheBucketAroundIt) {
  for (std::int64_t value = 1; value < (std::int64_t{1} << 39); value = value * 9 / 8 + 1) {
    Histogram histogram;
    histogram.add(value);
    std::size_t bucket = 0;
    while (histogram.count_in(bucket) == 0) ++bucket;
    EXPECT_LT(static_cast<double>(value), Histogram::upper_edge_ns(bucket));
    EXPECT_GE(static_cast<double>(value), Histogram::upper_edge_ns(bucket - 1));
  }
}

TEST(Histogram, KeepsDurationsThatItCannotResolve) {
  Histogram histogram;
  histogram.add(-5);
  histogram.add(std::int64_t{1} << 60);
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.count_in(0), 1U) << "nothing takes less than no time";
  EXPECT_EQ(histogram.count_in(Histogram::bucket_count - 1), 1U);
}

TEST(Histogram, IsZeroWhenEmptyAndWhenTimeStandsStill) {
  Histogram histogram;
  EXPECT_EQ(histogram.percentile_ns(0.5), 0.0);
  EXPECT_EQ(histogram.mean_ns(), 0.0);
  histogram.add(0);
  EXPECT_EQ(histogram.percentile_ns(0.99), 0.0);
}

TEST(Histogram, CountsWhatAnotherHasCounted) {
  Histogram all;
  Histogram halves[2];
  for (std::int64_t ns = 1; ns < 5000; ++ns) {
    all.add(ns * ns);
    halves[ns % 2].add(ns * ns);
  }
  halves[0].add(halves[1]);
  EXPECT_EQ(halves[0].count(), all.count());
  EXPECT_EQ(halves[0].mean_ns(), all.mean_ns());
  EXPECT_EQ(halves[0].max_ns(), all.max_ns());
  EXPECT_EQ(halves[0].percentile_ns(0.9), all.percentile_ns(0.9));
}

}  // namespace
}  // namespace kerf::bench
