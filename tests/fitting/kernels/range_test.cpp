#include "kernels/wide/range.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::fitting::wide {
namespace {

// Four numbers at a time, and up to three that are left.
TEST(Range, IsThatOfEveryNumberWhereverItStands) {
  for (std::size_t count = 1; count <= 13; ++count) {
    for (std::size_t place = 0; place < count; ++place) {
      std::vector<double> values(count, 1.0);
      values[place] = -3.0;
      EXPECT_EQ(range_of(values).least, -3.0) << place << " of " << count;
      EXPECT_EQ(range_of(values).most, count == 1 ? -3.0 : 1.0);
      values[place] = 7.0;
      EXPECT_EQ(range_of(values).most, 7.0) << place << " of " << count;
      EXPECT_TRUE(range_of(values).is_finite);
      for (const double odd :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()}) {
        values[place] = odd;
        EXPECT_FALSE(range_of(values).is_finite) << odd << " at " << place << " of " << count;
      }
      values[place] = std::numeric_limits<double>::max();
      EXPECT_TRUE(range_of(values).is_finite) << "the largest there is";
    }
  }
}

}  // namespace
}  // namespace kerf::fitting::wide
