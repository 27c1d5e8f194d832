#include "signal/quantiles.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(Median, IsTheMiddleValueOrTheMeanOfTwo) {
  EXPECT_EQ(median({5.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({8.0, 1.0, 2.0, 4.0}), 3.0);
}

TEST(MedianPeriod, IsNotMovedByAGap) {
  EXPECT_DOUBLE_EQ(median_period(std::vector{0.0, 1.0, 2.0, 50.0, 51.0}), 1.0);
  EXPECT_EQ(median_period(std::vector{3.0}), 0.0);
}

TEST(Quantile, LiesBetweenTwoValuesByDistance) {
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.0), 1.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
  EXPECT_EQ(quantile({40.0, 10.0, 30.0, 20.0, 50.0}, 0.25), 20.0);
  EXPECT_DOUBLE_EQ(quantile({40.0, 10.0, 30.0, 20.0, 50.0}, 0.9), 46.0);
  EXPECT_EQ(quantile({7.0}, 0.3), 7.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Quantile, OfAHalfIsTheMedian) {
  EXPECT_EQ(quantile({5.0, 1.0, 2.0}, 0.5), median({5.0, 1.0, 2.0}));
  EXPECT_EQ(quantile({8.0, 1.0, 2.0, 4.0}, 0.5), median({8.0, 1.0, 2.0, 4.0}));
}

}  // namespace
}  // namespace kerf::bench
