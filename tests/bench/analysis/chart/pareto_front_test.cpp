#include "chart/pareto_front.h"

#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ParetoFront, RisesInCostAndFallsInError) {
  const std::vector<ParetoEntry> entries{
      {1000.0, 10.0, 3, "dear and right"}, {10.0, 200.0, 3, "cheap and wrong"}, {100.0, 50.0, 3, "between"}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(1, 2, 0));
}

TEST(ParetoFront, LeavesOutWhatIsDearerAndNoBetter) {
  const std::vector<ParetoEntry> entries{
      {10.0, 100.0, 3, "first"}, {50.0, 100.0, 3, "as wrong"}, {50.0, 150.0, 3, "worse"}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(0));
}

TEST(ParetoFront, TakesTheLeastErrorAmongEqualCosts) {
  const std::vector<ParetoEntry> entries{
      {100.0, 100.0, 3, "a"}, {110.0, 50.0, 9, "b"}, {200.0, 40.0, 9, "c"}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(1, 2)) << "110 ns is no more than 15 % over 100 ns";
}

TEST(ParetoFront, TakesTheFewestParametersAmongEquals) {
  const std::vector<ParetoEntry> entries{
      {100.0, 100.0, 9, "a"}, {104.0, 100.004, 3, "b"}, {101.0, 100.004, 3, "a"}, {99.0, 150.0, 1, "worse"}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(2)) << "of two with three parameters the first by name";
}

TEST(ParetoFront, TakesTheSimplerOfTwoEqualsAlsoJustBeyondTheEdgeOfAClass) {
  const std::vector<ParetoEntry> entries{
      {100.0, 900.0, 1, "a"}, {117.0, 100.0, 20, "b"}, {119.0, 100.0, 3, "c"}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(2)) << "the class ends at 118 ns";
}

TEST(ParetoFront, CountsAFewNanosecondsForNothing) {
  const std::vector<ParetoEntry> entries{{4.0, 100.0, 3, "a"}, {7.5, 50.0, 3, "b"}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(1)) << "4 ns + 15 % + 3 ns = 7.6 ns";
}

TEST(ParetoFront, HasNothingThatIsNotStable) {
  const std::vector<ParetoEntry> entries{{1.0, 0.0, 1, "unstable", false}, {10.0, 100.0, 1, "stable", true}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(1));
  EXPECT_THAT(pareto_front(std::vector<ParetoEntry>{}), IsEmpty());
}

TEST(ParetoFront, EndsWhereNobodyCouldTellTheErrorApart) {
  const std::vector<ParetoEntry> entries{{10.0, 3.0, 3, "a"}, {100.0, 2.9, 3, "b"}, {1000.0, 2.0, 3, "c"}};
  EXPECT_THAT(pareto_front(entries), ElementsAre(0, 2)) << "sqrt(9 - 8.41) = 0.77 JND, sqrt(9 - 4) = 2.2 JND";
}

TEST(ParetoFront, GoesByWhatCountsAsGood) {
  const std::vector<ParetoEntry> entries{{10.0, 3.0, 3, "a"}, {100.0, 0.1, 3, "b"}};
  EXPECT_THAT(pareto_front(entries, [](auto, auto) { return true; }), ElementsAre(0));
}

TEST(ParetoFront, StaysTheSameWhenTheMachineIsALittleBusy) {
  // Costs as measured: three classes, with gaps that are wider than what a busy machine adds.
  const std::vector<ParetoEntry> measured{{16.0, 90.0, 3, "kelvin"},     {17.0, 90.0, 5, "maxwell"},
                                          {38.0, 40.0, 10, "piecewise"}, {40.0, 40.01, 16, "recording"},
                                          {280.0, 1.0, 8, "blade"},      {300.0, 1.0, 9, "blade"}};
  const auto front = pareto_front(measured);
  EXPECT_THAT(front, ElementsAre(0, 2, 4));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> factor(0.96, 1.04);
  for (int run = 0; run < 1000; ++run) {
    auto again = measured;
    for (ParetoEntry& entry : again) entry.cost_ns *= factor(random);
    ASSERT_EQ(pareto_front(again), front) << run;
  }
}

}  // namespace
}  // namespace kerf::bench
