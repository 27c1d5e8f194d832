#include "regress/compare.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A stroke of 1,000 ticks with a force of up to 3 N.
schema::StoredForces stored() {
  schema::StoredForces one{.name = "one", .channels = {{"theta", "N"}}};
  for (int i = 0; i < 1000; ++i) one.force.push_back(3.0 * std::pow(std::sin(0.003 * i), 2));
  return one;
}

RenderedForces as_stored(const schema::StoredForces& one) {
  return {.channels = one.channels, .force = one.force, .faults = one.faults};
}

TEST(CompareForces, PassesTheSameBits) {
  const ForceComparison same = compare_forces(stored(), as_stored(stored()), {.exact = true});
  EXPECT_TRUE(same.passed);
  EXPECT_EQ(same.differing, 0U);
  EXPECT_FALSE(same.worst);
}

TEST(CompareForces, SeesTheLastBitWhereItHasTo) {
  RenderedForces got = as_stored(stored());
  got.force[400] = std::nextafter(got.force[400], 10.0);
  const ForceComparison exact = compare_forces(stored(), got, {.exact = true});
  EXPECT_FALSE(exact.passed);
  EXPECT_EQ(exact.outside, 1U);
  EXPECT_EQ(exact.worst->tick, 400U);
  EXPECT_TRUE(compare_forces(stored(), got, {.relative = 1e-15}).passed);
  EXPECT_EQ(compare_forces(stored(), got, {.relative = 1e-15}).differing, 1U);
}

TEST(CompareForces, TellsMinusZeroFromZeroOnlyBitForBit) {
  RenderedForces got = as_stored(stored());
  got.force[0] = -0.0;
  EXPECT_FALSE(compare_forces(stored(), got, {.exact = true}).passed);
  EXPECT_TRUE(compare_forces(stored(), got, {.relative = 0.0}).passed);
}

TEST(CompareForces, AllowsTheLargestOfTheTolerancesGiven) {
  RenderedForces got = as_stored(stored());
  const double at_500 = stored().force[500];
  got.force[500] += 0.01;
  EXPECT_FALSE(compare_forces(stored(), got, {.force_n = 0.009}).passed);
  EXPECT_TRUE(compare_forces(stored(), got, {.force_n = 0.011}).passed);
  EXPECT_FALSE(compare_forces(stored(), got, {.relative = 0.009 / at_500}).passed);
  EXPECT_TRUE(compare_forces(stored(), got, {.relative = 0.011 / at_500}).passed);
  EXPECT_TRUE(compare_forces(stored(), got, {.force_n = 1e-9, .relative = 0.011 / at_500}).passed);
  EXPECT_FALSE(compare_forces(stored(), got, {.torque_n_m = 1.0}).passed) << "this is no torque";
}

TEST(CompareForces, CountsInJnds) {
  RenderedForces got = as_stored(stored());
  got.force[500] += 0.1;
  const double jnd_n = 0.07 * stored().force[500];  // 7 % of 2.98 N, more than 0.05 N
  const ForceComparison comparison = compare_forces(stored(), got, {.jnd = 0.4});
  EXPECT_FALSE(comparison.passed);
  EXPECT_NEAR(comparison.worst->jnds, 0.1 / jnd_n, 1e-9);
  EXPECT_TRUE(compare_forces(stored(), got, {.jnd = 0.5}).passed);
}

TEST(CompareForces, JudgesATorqueByItsOwnJnd) {
  const schema::StoredForces one{.name = "one", .channels = {{"rx", "N·m"}}, .force = {0.01, 0.01}};
  RenderedForces got = as_stored(one);
  got.force[1] += 0.00127;  // 12.7 %
  EXPECT_NEAR(compare_forces(one, got, {.jnd = 0.9}).worst->jnds, 1.0, 1e-9);
  EXPECT_TRUE(compare_forces(one, got, {.jnd = 1.001}).passed);
}

TEST(CompareForces, FindsTheWorstTickAndItsChannel) {
  schema::StoredForces one{.name = "one", .channels = {{"x", "N"}, {"y", "N"}}};
  one.force.assign(200, 1.0);
  RenderedForces got = as_stored(one);
  got.force[60] = 1.2;
  got.force[141] = 0.5;
  got.force[180] = 1.01;  // within the tolerance
  const ForceComparison comparison = compare_forces(one, got, {.force_n = 0.1});
  EXPECT_EQ(comparison.outside, 2U);
  EXPECT_EQ(comparison.worst->tick, 70U);
  EXPECT_EQ(comparison.worst->channel, 1U);
  EXPECT_THAT(comparison.messages,
              ElementsAre(StartsWith(
                  "the force is outside the tolerance in 2 of 100 ticks, and differs at all in 3; worst "
                  "at tick 70, y: expected 1 N, got 0.5 N, 0.5 N apart")));
  EXPECT_EQ(comparison.channels[0].outside, 1U);
  EXPECT_DOUBLE_EQ(comparison.channels[1].largest_difference, 0.5);
}

TEST(CompareForces, PassesNoNumberThatIsNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    RenderedForces got = as_stored(stored());
    got.force[10] = bad;
    const ForceComparison comparison = compare_forces(stored(), got, {.force_n = 1e300, .jnd = 100.0});
    EXPECT_FALSE(comparison.passed);
    EXPECT_EQ(comparison.worst->tick, 10U);
  }
}

TEST(CompareForces, NeverPassesALostSampleOrAnAddedOne) {
  const Tolerance anything{.force_n = 1e6};
  RenderedForces got = as_stored(stored());
  got.force.pop_back();
  EXPECT_THAT(compare_forces(stored(), got, anything).messages,
              ElementsAre("999 samples where 1000 are stored: 1 lost"));
  EXPECT_THAT(sentences_of(diagnose(stored(), got), stored()),
              ElementsAre("what is there is the same: the end is missing"));
  got = as_stored(stored());
  got.force.push_back(0.0);
  EXPECT_THAT(compare_forces(stored(), got, anything).messages,
              ElementsAre("1001 samples where 1000 are stored: 1 added"));
}

TEST(CompareForces, NeverPassesOtherChannelsOrMoreFaults) {
  RenderedForces got = as_stored(stored());
  got.channels[0].unit = "N·m";
  EXPECT_THAT(compare_forces(stored(), got, {.force_n = 1e6}).messages,
              ElementsAre("the forces are theta [N·m] where theta [N] are stored"));
  got = as_stored(stored());
  got.faults = 2;
  got.first_fault = 77;
  EXPECT_THAT(compare_forces(stored(), got, {.force_n = 1e6}).messages,
              ElementsAre("the law faulted in 2 ticks where 0 are stored, first in tick 77"));
}

TEST(CompareForces, DiagnosesAsTheLibraryDoes) {
  RenderedForces got = as_stored(stored());
  for (double& force : got.force) force *= 180.0 / std::numbers::pi;
  EXPECT_THAT(sentences_of(diagnose(stored(), got), stored()),
              Contains(HasSubstr("180/pi: degrees where radians are meant")));
  got = as_stored(stored());
  got.force.erase(got.force.begin() + 400);
  EXPECT_THAT(sentences_of(diagnose(stored(), got), stored()),
              ElementsAre("a sample is missing, at tick 400"));
  EXPECT_THAT(diagnose(stored(), as_stored(stored()), {}, {.trajectory_changed = true}).names, IsEmpty());
}

}  // namespace
}  // namespace kerf::bench
