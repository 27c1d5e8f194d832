#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/compare/compare.h>

#include "compare/runs.h"

namespace kerf::compare {
namespace {

using test::run_of;
using test::strokes;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

TEST(Compare, PassesNothingThatIsNotFiniteNotEvenIfItWasExpected) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<double> force = strokes();
    force[77] = bad;
    for (const Tolerance& tolerance :
         {Tolerance{.force_n = 1e300}, Tolerance{.exact = true}, Tolerance{.jnd = 9.0}}) {
      const Comparison same = compare(run_of(force), run_of(force), tolerance);
      ASSERT_FALSE(same.passed);
      EXPECT_EQ(same.first_outside, 77U);
      EXPECT_THAT(same.messages.back(), HasSubstr("it was never right"));
    }
  }
}

TEST(Compare, MarksWhereAForceIsOutside) {
  std::vector<double> force = strokes();
  for (const std::size_t tick : {100U, 105U, 500U}) force[tick] += 1.0;
  const Comparison comparison = compare(run_of(strokes()), run_of(force), {.force_n = 0.1});
  const ChannelComparison& channel = comparison.channels.at(0);
  EXPECT_EQ(channel.first_outside, 100U);
  ASSERT_THAT(channel.intervals, SizeIs(2));
  EXPECT_EQ(channel.intervals[0].end, 106U);
  EXPECT_EQ(channel.intervals[1].begin, 500U);
}

TEST(Compare, TakesADifferenceAsLargeAsIsAllowedForAllowed) {
  std::vector<double> expected;
  std::vector<double> at_the_edge;
  std::vector<double> beyond;
  std::vector<double> by_a_hundredth;
  for (const double force : strokes()) {
    expected.push_back(1e-6 * std::round(1e6 * force));
    at_the_edge.push_back(expected.back() + 0.01);
    beyond.push_back(expected.back() + 0.0100001);
    by_a_hundredth.push_back(expected.back() * 1.01);
  }
  EXPECT_EQ(
      compare(run_of(expected), run_of(at_the_edge), {.force_n = 0.01, .peak = {.force = 0.01}}).messages,
      std::vector<std::string>{});
  EXPECT_TRUE(compare(run_of(expected), run_of(by_a_hundredth), {.relative = 0.01}).passed);
  EXPECT_EQ(compare(run_of(expected), run_of(beyond), {.force_n = 0.01}).outside, expected.size());
  EXPECT_FALSE(compare(run_of({1.0}), run_of({std::nextafter(1.0, 2.0)}), {.force_n = 0.0}).passed);
}

TEST(Compare, KnowsWhereTheLargestDifferenceIs) {
  std::vector<double> expected(100, 2.0);
  std::vector<double> got = expected;
  expected[20] = 0.0;
  got[20] = 1.0;   // 20 JNDs
  got[30] = -1.5;  // 25 of 0.14 N
  got[40] = 4.0;
  const Comparison comparison = compare(run_of(expected), run_of(got), {.jnd = 1.0});
  EXPECT_EQ(comparison.channels[0].largest_difference, 3.5);
  EXPECT_EQ(comparison.channels[0].largest_at, 30U);
  expected[20] = -1.5;
  got[20] = 1.5;  // 28 JNDs, and less than 3.5 N
  const Comparison felt = compare(run_of(expected), run_of(got), {.jnd = 1.0});
  EXPECT_EQ(felt.worst->tick, 20U);
  EXPECT_EQ(felt.channels[0].largest_at, 30U);
  EXPECT_THAT(felt.messages.at(0), AllOf(HasSubstr("worst at tick 20, theta:"),
                                         HasSubstr("; the largest difference, 3.5 N, is at tick 30")));
}

TEST(Compare, HoldsAChannelToItsOwnTolerance) {
  const Series expected = test::six_axes();
  Series got = expected;
  got.channels[4].value[9] += 1e-4;
  const Tolerance loose{.force_n = 1.0, .torque_n_m = 1.0};
  EXPECT_TRUE(compare(expected, got, loose).passed);
  Tolerance own = loose;
  own.channels.push_back({.channel = "ry", .tolerance = {.exact = true}});
  EXPECT_THAT(compare(expected, got, own).messages, ElementsAre(HasSubstr("worst at tick 9, ry:")));
}

TEST(Compare, LimitsSlewDriftAndPeakOfTheWholeRun) {
  std::vector<double> force = strokes();
  force[2000] += 0.02;
  const auto failing = [&](const Tolerance& tolerance) {
    return compare(run_of(strokes()), run_of(force), tolerance).messages;
  };
  EXPECT_THAT(failing({.force_n = 0.1, .slew = {.force = 19.0}}),
              ElementsAre("theta: the difference changes by 20 N/s, where 19 N/s is allowed, at tick 2000"));
  EXPECT_THAT(failing({.force_n = 0.1, .slew = {.force = 21.0}}), ElementsAre());
  force = strokes();
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += 0.05 * static_cast<double>(i) / 4000.0;
  EXPECT_THAT(failing({.force_n = 0.1, .drift = {.force = 0.049}}),
              ElementsAre(HasSubstr("drifts over the run by 0.05 N")));
  EXPECT_THAT(failing({.force_n = 0.1, .drift = {.force = 0.051}}), ElementsAre());
  force = strokes();
  for (double& one : force) one *= 1.01;
  EXPECT_THAT(failing({.relative = 0.02, .peak = {.force = 0.02}}),
              ElementsAre(HasSubstr("the largest force is off by 0.0")));
  EXPECT_THAT(failing({.relative = 0.02, .peak = {.torque = 0.0}}), ElementsAre()) << "a limit of torques";
}

TEST(Compare, JudgesWhatIsLeftWhereASampleIsMissing) {
  std::vector<double> force = strokes();
  force.erase(force.begin() + 300);
  force[2000] += 0.5;
  const Comparison comparison = compare_with_gaps(run_of(strokes()), run_of(force), {.force_n = 0.1});
  EXPECT_FALSE(comparison.passed);
  EXPECT_EQ(comparison.outside, 1U) << "not every tick after the one that is missing";
  EXPECT_EQ(comparison.worst->tick, 2001U);
  EXPECT_EQ(comparison.worst->got_tick, 2000U);
  EXPECT_THAT(comparison.messages,
              ElementsAre("3999 samples where 4000 are stored: 1 lost",
                          AllOf(StartsWith("besides, of the ticks that both have: the force is"),
                                HasSubstr("worst at tick 2001"))));
}

TEST(Compare, RefusesARunWithoutSense) {
  const auto why = [](const Series& series) {
    try {
      require_sound(series, "run.csv");
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(why(run_of(strokes())), "");
  EXPECT_THAT(why({}), HasSubstr("run.csv: there is no force"));
  EXPECT_THAT(why(run_of({1.0}, 1e-3, "kg")), HasSubstr("'theta' is in 'kg', expected N or N·m"));
  Series back = run_of({1.0, 2.0, 3.0});
  back.time_s = {0.0, 2.0, 1.0};
  EXPECT_THAT(why(back), HasSubstr("the time of row 2 is 1 s after 2 s"));
  back.time_s.clear();
  back.positions = {{.name = "theta", .unit = "rad", .value = {1.0}}};
  EXPECT_THAT(why(back), HasSubstr("'theta' has 1 rows where the others have 3"));
}

}  // namespace
}  // namespace kerf::compare
