#include "signal/value_counts.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

TEST(ValueCounts, KnowTheMedianOfTheValuesAdded) {
  std::mt19937_64 random(3);
  for (const int count : {1, 2, 3, 10, 999, 1000}) {
    std::uniform_int_distribution<int> few(-3, 4);
    ValueCounts counts;
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      values.push_back(0.1 * few(random));
      counts.add(values.back());
    }
    EXPECT_EQ(counts.median(), median(values)) << count;
  }
  EXPECT_TRUE(std::isnan(ValueCounts{}.median()));
}

TEST(ValueCounts, CountWhatIsGreater) {
  ValueCounts counts;
  for (const double value : {-1.0, 2.0, 2.0, 3.0}) counts.add(value);
  EXPECT_EQ(counts.above(-1.0), 3U);
  EXPECT_EQ(counts.above(2.0), 1U);
  EXPECT_EQ(counts.above(3.0), 0U);
}

}  // namespace
}  // namespace kerf::bench
