#include "import/time_order.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(TimeOrder, KeepsWhatIncreases) {
  EXPECT_THAT(rows_in_order(std::vector<double>{1, 2, 4, 7}), ElementsAre(0U, 1U, 2U, 3U));
  EXPECT_THAT(rows_in_order(std::vector<double>{}), IsEmpty());
}

TEST(TimeOrder, KeepsTheFirstOfRepeatedStamps) {
  EXPECT_THAT(rows_in_order(std::vector<double>{1, 1, 1, 2, 2, 3}), ElementsAre(0U, 3U, 5U));
}

TEST(TimeOrder, LeavesOutAsFewRowsAsWillDo) {
  EXPECT_THAT(rows_in_order(std::vector<double>{1, 2, 900, 3, 4}), ElementsAre(0U, 1U, 3U, 4U));
  EXPECT_THAT(rows_in_order(std::vector<double>{5, 6, 1, 7, 8}), ElementsAre(0U, 1U, 3U, 4U));
  EXPECT_THAT(rows_in_order(std::vector<double>{900, 1, 2}), ElementsAre(1U, 2U));
}

TEST(TimeOrder, KeepsTheEarlierOfChoicesThatAreAlike) {
  EXPECT_THAT(rows_in_order(std::vector<double>{1, 2, 3, 1, 2, 3}), ElementsAre(0U, 1U, 2U));
  EXPECT_THAT(rows_in_order(std::vector<double>{0, 1, 0.5, 2}), ElementsAre(0U, 1U, 3U));
}

TEST(TimeOrder, TakesNoTimeThatIsNotFinite) {
  EXPECT_THAT(rows_in_order(std::vector<double>{NAN, 1, INFINITY, 2, -INFINITY, NAN}), ElementsAre(1U, 3U));
}

}  // namespace
}  // namespace kerf::bench
