#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/population/compare.h>

namespace kerf::population {
namespace {

/// One recording of each specimen, of names that begin with `name`.
std::vector<Estimate> specimens(const std::string& name, std::initializer_list<double> values) {
  std::vector<Estimate> estimates;
  for (const double value : values)
    estimates.push_back(
        {.value = value, .standard_error = {}, .specimen = name + std::to_string(estimates.size())});
  return estimates;
}

Comparison compared(const Pair& pair, const CompareOptions& options = {}) {
  return compare(std::vector{pair}, options).front();
}

TEST(Compare, CannotTellTwoFromTwo) {
  const Comparison one = compared({specimens("a", {1.0, 1.1}), specimens("b", {9.0, 9.1})});
  EXPECT_EQ(one.verdict, Verdict::cannot_be_told);
  EXPECT_NEAR(one.test->least_p, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(one.test->p, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(*one.difference, -8.0, 1e-12);
  EXPECT_TRUE(one.interval);
}

TEST(Compare, CountsEveryWayToDivideSpecimens) {
  const Comparison apart =
      compared({specimens("a", {1.0, 1.2, 1.1, 0.9}), specimens("b", {2.0, 2.2, 2.1, 1.9})});
  EXPECT_TRUE(apart.test->is_exact);
  EXPECT_NEAR(apart.test->p, 2.0 / 70.0, 1e-12);
  EXPECT_EQ(apart.verdict, Verdict::differ);
  EXPECT_EQ(apart.test->exchange, Exchange::whole_specimens);
  // One pair of values the other way round: four of 70 are as extreme by Welch's t.
  const Comparison mixed =
      compared({specimens("a", {1.0, 2.0, 3.0, 5.0}), specimens("b", {4.0, 6.0, 7.0, 8.0})});
  EXPECT_NEAR(mixed.test->p, 4.0 / 70.0, 1e-12);
  EXPECT_EQ(mixed.verdict, Verdict::not_told_apart);
}

TEST(Compare, SaysTheLeastOfUnequalGroups) {
  EXPECT_NEAR(compared({specimens("a", {1.0, 1.2}), specimens("b", {2.0, 2.2, 2.1})}).test->least_p, 0.1,
              1e-12);
  EXPECT_NEAR(compared({specimens("a", {1.0}), specimens("b", {2.0})}).test->least_p, 1.0, 1e-12);
}

TEST(Compare, HasWelchsInterval) {
  const Comparison one = compared({specimens("a", {1.0, 1.2, 1.4}), specimens("b", {2.0, 2.6, 3.2, 2.2})});
  // R: t.test(c(1, 1.2, 1.4), c(2, 2.6, 3.2, 2.2)).
  EXPECT_NEAR(one.degrees_of_freedom, 4.03225806451613, 1e-8);
  EXPECT_NEAR(one.interval->lower, -2.098968250592, 1e-9);
  EXPECT_NEAR(one.interval->upper, -0.501031749408, 1e-9);
  EXPECT_NEAR(*one.model_p, 0.0105969810857, 1e-12);
}

TEST(Compare, HasHedgesG) {
  const Comparison one = compared({specimens("a", {1.0, 1.2, 1.4}), specimens("b", {2.0, 2.6, 3.2, 2.2})});
  const double pooled = std::sqrt((0.08 + 0.84) / 5.0);
  EXPECT_NEAR(*one.hedges_g, (1.0 - 3.0 / 19.0) * (1.2 - 2.5) / pooled, 1e-12);
}

TEST(Compare, MovesASpecimenWithAllItsRecordings) {
  std::vector<Estimate> first;
  std::vector<Estimate> second;
  for (int i = 0; i < 20; ++i) {
    first.push_back({.value = 1.0 + 0.01 * i, .standard_error = 0.01, .specimen = i % 2 == 0 ? "a" : "b"});
    second.push_back({.value = 3.0 + 0.01 * i, .standard_error = 0.01, .specimen = i % 2 == 0 ? "c" : "d"});
  }
  const Comparison one = compared({first, second});
  EXPECT_EQ(one.verdict, Verdict::cannot_be_told) << "40 recordings are still four specimens";
  EXPECT_EQ(one.first_units, 2U);
}

/// Specimens that are far apart, each cut twice at either speed.
Pair crossed_pair() {
  Pair pair;
  for (int i = 0; i < 4; ++i) {
    const std::string name = std::to_string(i);
    for (const double more : {0.0, 0.01 + 0.003 * i}) {
      pair.first.push_back(
          {.value = 10.0 * i + 1.0 + more + 0.02 * i, .standard_error = 0.01, .specimen = name});
      pair.second.push_back({.value = 10.0 * i + more, .standard_error = 0.01, .specimen = name});
    }
  }
  return pair;
}

TEST(Compare, StaysWithinSpecimensThatAreInBoth) {
  const Comparison one = compared(crossed_pair());
  EXPECT_TRUE(one.is_crossed);
  EXPECT_EQ(one.test->exchange, Exchange::recordings_in_specimen);
  EXPECT_NEAR(one.test->p, 2.0 / 1296.0, 1e-12);
  EXPECT_EQ(one.verdict, Verdict::differ);
  EXPECT_NEAR(*one.difference, 1.03, 1e-9);
  EXPECT_LT(one.interval->upper - one.interval->lower, 0.1) << "what specimens differ by takes no part";
}

TEST(Compare, ExchangesWholeGroupsWhereAsked) {
  const Comparison one = compared(crossed_pair(), {.exchanges_recordings = false});
  EXPECT_EQ(one.test->exchange, Exchange::groups_in_specimen);
  EXPECT_NEAR(one.test->p, 2.0 / 16.0, 1e-12);
  EXPECT_EQ(one.verdict, Verdict::cannot_be_told);
}

TEST(Compare, LeavesOutWhatBreaksTheDesign) {
  Pair pair = crossed_pair();
  pair.first.push_back({.value = 500.0, .standard_error = 0.01, .specimen = "in the first alone"});
  pair.second.push_back(
      {.value = 1.0, .standard_error = std::numeric_limits<double>::infinity(), .specimen = "0"});
  const Comparison one = compared(pair);
  EXPECT_EQ(one.left_out, 2U);
  EXPECT_NEAR(*one.difference, 1.03, 1e-9);
  Pair nearly_nested{specimens("a", {1.0, 1.2, 1.1, 0.9}), specimens("b", {2.0, 2.2, 2.1, 1.9})};
  nearly_nested.first.push_back({.value = 7.0, .standard_error = {}, .specimen = "both"});
  nearly_nested.second.push_back({.value = 7.5, .standard_error = {}, .specimen = "both"});
  const Comparison nested = compared(nearly_nested);
  EXPECT_FALSE(nested.is_crossed);
  EXPECT_EQ(nested.left_out, 2U);
  EXPECT_NEAR(nested.test->p, 2.0 / 70.0, 1e-12);
}

TEST(Compare, DrawsWhereThereAreTooMany) {
  const Pair pair{specimens("a", {1, 4, 2, 6, 3, 5, 9, 8}), specimens("b", {7, 9, 12, 8, 10, 6, 5, 11})};
  const double exact = compared(pair).test->p;
  const PermutationTest drawn = *compared(pair, {.most_exact = 100}).test;
  EXPECT_FALSE(drawn.is_exact);
  EXPECT_GT(drawn.standard_error, 0.0);
  EXPECT_NEAR(drawn.p, exact, 4.0 * drawn.standard_error);
  EXPECT_EQ(drawn.p, compared(pair, {.most_exact = 100}).test->p) << "a seed gives the same again";
  EXPECT_NE(drawn.p, compared(pair, {.most_exact = 100, .seed = 2}).test->p);
  EXPECT_EQ(compared(pair, {.draws = 99, .most_exact = 100}).test->least_p, 0.01);
}

TEST(Compare, CorrectsForAllThatWereAsked) {
  const Pair apart{specimens("a", {1.0, 1.2, 1.1, 0.9}), specimens("b", {2.0, 2.2, 2.1, 1.9})};
  const Pair hopeless{specimens("a", {1.0}), specimens("b", {2.0})};
  const std::vector<Comparison> with_hopeless = compare(std::vector{apart, hopeless});
  EXPECT_EQ(with_hopeless[0].verdict, Verdict::differ) << "what cannot be told is no test to correct for";
  EXPECT_EQ(with_hopeless[1].verdict, Verdict::cannot_be_told);
  const std::vector<Comparison> two = compare(std::vector{apart, apart});
  EXPECT_NEAR(two[0].holm_p, 4.0 / 70.0, 1e-12);
  EXPECT_NEAR(two[0].benjamini_hochberg_p, 2.0 / 70.0, 1e-12);
  EXPECT_EQ(two[0].verdict, Verdict::cannot_be_told) << "no data of four and four pass two such tests";
  EXPECT_NEAR(two[0].least_holm_p, 4.0 / 70.0, 1e-12);
}

TEST(Compare, CountsRecordingsWhereSpecimensAreUnknown) {
  Pair pair{specimens("a", {1.0, 1.2, 1.1, 0.9}), specimens("b", {2.0, 2.2, 2.1, 1.9})};
  pair.second[0].specimen.reset();
  EXPECT_EQ(compared(pair).test->exchange, Exchange::recordings);
}

TEST(Compare, HasNoTestWithoutData) {
  const Comparison one = compared({specimens("a", {1.0, 1.2}), {}});
  EXPECT_FALSE(one.test);
  EXPECT_FALSE(one.difference);
  EXPECT_EQ(one.verdict, Verdict::cannot_be_told);
}

TEST(Compare, RefusesOptionsThatCannotBe) {
  EXPECT_THROW((void)compared({}, {.level = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)compared({}, {.confidence = 1.0}), std::invalid_argument);
  EXPECT_THROW((void)compared({}, {.draws = 10}), std::invalid_argument);
}

TEST(Verdicts, HaveNames) {
  EXPECT_STREQ(name_of(Verdict::differ), "differ");
  EXPECT_STREQ(name_of(Verdict::not_told_apart), "not told apart");
  EXPECT_STREQ(name_of(Verdict::cannot_be_told), "cannot be told");
}

}  // namespace
}  // namespace kerf::population
