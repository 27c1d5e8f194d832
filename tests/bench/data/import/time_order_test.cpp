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

/// Stretches of 20 rows, each from 0 on.
std::vector<double> stretches(std::size_t count) {
  std::vector<double> time;
  for (std::size_t row = 0; row < 20 * count; ++row) time.push_back(0.01 * static_cast<double>(row % 20));
  return time;
}

TEST(ClockRestarts, AreWhereTheTimeBeginsAgain) {
  EXPECT_THAT(clock_restarts(stretches(3)), ElementsAre(20U, 40U));
  EXPECT_THAT(clock_restarts(stretches(1)), IsEmpty());
  EXPECT_THAT(clock_restarts(std::vector<double>{}), IsEmpty());
}

TEST(ClockRestarts, AreNoneOfAStampThatLeaps) {
  std::vector<double> time = stretches(1);
  time[12] = 900.0;
  EXPECT_THAT(clock_restarts(time), IsEmpty());
  time[12] = -900.0;
  EXPECT_THAT(clock_restarts(time), IsEmpty());
  time[12] = time[11];
  EXPECT_THAT(clock_restarts(time), IsEmpty());
  time[12] = std::nan("");
  EXPECT_THAT(clock_restarts(time), IsEmpty());
}

TEST(ClockRestarts, AreNoneOfAFewRows) {
  std::vector<double> time = stretches(2);
  time.resize(25);
  EXPECT_THAT(clock_restarts(time), IsEmpty()) << "five rows of a second stretch";
}

}  // namespace
}  // namespace kerf::bench
