#include "signal/quantiles.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "signal/streamed_median.h"

namespace kerf::bench {
namespace {

TEST(Median, IsTheMiddleValueOrTheMeanOfTwo) {
  EXPECT_EQ(median({5.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({8.0, 1.0, 2.0, 4.0}), 3.0);
}

TEST(StreamedMedian, IsThatOfTheValuesKept) {
  std::mt19937_64 random(3);
  for (const std::size_t count : {1U, 2U, 3U, 10U, 999U, 1000U, 131072U, 131073U, 131074U}) {
    for (const double spread : {0.0, 1e-18, 1e-3, 1e300}) {
      std::normal_distribution<double> normal(1e-3, 1.0);
      std::vector<double> values;
      for (std::size_t i = 0; i < count; ++i) values.push_back(1e-3 + spread * normal(random));
      const auto for_each = [&](const auto& look) {
        for (const double value : values) look(value);
      };
      EXPECT_EQ(StreamedMedian::of(for_each), median(values)) << count << " " << spread;
    }
  }
  EXPECT_TRUE(std::isnan(StreamedMedian::of([](const auto&) {})));
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
