#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include <kerf/psychophysics/balance.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

class WilliamsSquare : public testing::TestWithParam<std::size_t> {};

TEST_P(WilliamsSquare, HasEachConditionOnceARowAndEvenlyAtEachPositionAndAfterEachOther) {
  const std::size_t n = GetParam();
  const Orders square = williams_square(n);
  const std::size_t times = n % 2 == 0 ? 1 : 2;
  ASSERT_EQ(square.size(), times * n);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> at;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> after;
  for (const auto& row : square) {
    EXPECT_EQ(std::set<std::size_t>(row.begin(), row.end()).size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      ++at[{i, row[i]}];
      if (i > 0) ++after[{row[i - 1], row[i]}];
    }
  }
  EXPECT_EQ(at.size(), n * n);
  for (const auto& [place, count] : at) EXPECT_EQ(count, times);
  EXPECT_EQ(after.size(), n * (n - 1));
  for (const auto& [pair, count] : after) EXPECT_EQ(count, times);
}

INSTANTIATE_TEST_SUITE_P(Sizes, WilliamsSquare, testing::Values(2, 3, 4, 5, 6, 9, 12));

TEST(WilliamsSquare, OfFourIsThePublishedOne) {
  EXPECT_EQ(williams_square(4), (Orders{{0, 3, 1, 2}, {1, 0, 2, 3}, {2, 1, 3, 0}, {3, 2, 0, 1}}));
}

TEST(CounterbalancedOrders, AreEvenOverEveryFullSquareAndFollowTheSeed) {
  const Orders orders = counterbalanced_orders(12, 4, 5);
  std::map<std::pair<std::size_t, std::size_t>, int> at;
  for (const auto& row : orders) {
    for (std::size_t i = 0; i < 4; ++i) ++at[{i, row[i]}];
  }
  for (const auto& [place, count] : at) EXPECT_EQ(count, 3);
  EXPECT_EQ(orders, counterbalanced_orders(12, 4, 5));
  EXPECT_NE(orders, counterbalanced_orders(12, 4, 6));
}

TEST(CounterbalancedComparisons, GiveEachLawTheFirstNameEquallyOften) {
  for (const std::size_t subjects : {1U, 3U, 8U}) {
    for (const std::size_t tissues : {1U, 4U, 5U}) {
      const auto plan = counterbalanced_comparisons(subjects, tissues, 17);
      std::vector<std::size_t> of_tissue(tissues, 0);
      for (const auto& row : plan) {
        ASSERT_EQ(row.size(), tissues);
        std::size_t of_subject = 0;
        for (const Comparison& comparison : row) {
          of_subject += comparison.is_swapped ? 1 : 0;
          of_tissue[comparison.tissue] += comparison.is_swapped ? 1 : 0;
        }
        EXPECT_TRUE(of_subject == tissues / 2 || of_subject == (tissues + 1) / 2);
      }
      for (const std::size_t count : of_tissue)
        EXPECT_TRUE(count == subjects / 2 || count == (subjects + 1) / 2);
    }
  }
}

// Whoever knows one assignment should know little of another: over seeds all balanced tables of 2 x 4 turn
// up.
TEST(CounterbalancedComparisons, ReachEveryBalancedAssignment) {
  std::set<std::vector<bool>> seen;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    std::vector<bool> table(8);
    const auto plan = counterbalanced_comparisons(2, 4, seed);
    for (std::size_t s = 0; s < 2; ++s) {
      for (const Comparison& comparison : plan[s]) table[4 * s + comparison.tissue] = comparison.is_swapped;
    }
    seen.insert(table);
  }
  EXPECT_EQ(seen.size(), 6U);  // two of four are swapped for the first subject, the other two for the second
}

TEST(BalancedSequence, HoldsEachKindEquallyOftenInEachBlock) {
  const std::vector<std::size_t> sequence = balanced_sequence(50, 3, 9, 12);
  ASSERT_EQ(sequence.size(), 50U);
  for (std::size_t block = 0; block < 4; ++block) {
    for (std::size_t kind = 0; kind < 3; ++kind) {
      const auto from = sequence.begin() + static_cast<std::ptrdiff_t>(12 * block);
      EXPECT_EQ(std::count(from, from + 12, kind), 4);
    }
  }
  EXPECT_EQ(sequence, balanced_sequence(50, 3, 9, 12));
  EXPECT_THROW((void)balanced_sequence(50, 3, 9, 10), std::invalid_argument);
}

// The standard fixes the engine's 10,000th number, so that these are the same wherever Kerf runs.
TEST(Random, IsTheSameOnEveryMachine) {
  Random random(5489);
  EXPECT_EQ(balanced_sequence(8, 2, 1), balanced_sequence(8, 2, 1));
  EXPECT_DOUBLE_EQ(random.uniform(), static_cast<double>(14514284786278117030ULL >> 11) * 0x1p-53);
}

TEST(Random, ShufflesEvenly) {
  Random random(3);
  std::map<std::vector<int>, int> counts;
  for (int i = 0; i < 6000; ++i) {
    std::vector<int> values{0, 1, 2};
    random.shuffle(values);
    ++counts[values];
  }
  EXPECT_EQ(counts.size(), 6U);
  for (const auto& [order, count] : counts) EXPECT_NEAR(count, 1000, 120);  // four standard deviations
}

TEST(Balance, RefusesEmptyPlans) {
  EXPECT_THROW((void)williams_square(0), std::invalid_argument);
  EXPECT_THROW((void)counterbalanced_orders(0, 3, 1), std::invalid_argument);
  EXPECT_THROW((void)counterbalanced_comparisons(3, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
