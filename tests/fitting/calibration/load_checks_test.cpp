#include <algorithm>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/calibration/load_checks.h>

#include "fitting/calibration/simulated_holds.h"

namespace kerf::fitting::calibration {
namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();

std::vector<Candidate> six_ways() {
  std::vector<Candidate> ways;
  for (std::size_t k = 0; k < 6; ++k) {
    std::vector<double> load(6, 0.0);
    load[k] = 1.0;
    ways.push_back({.name = std::to_string(k), .load = load});
  }
  return ways;
}

TEST(LoadChecks, FindNothingInGoodLoads) {
  const Holds holds = simulate(Simulated{}, 1).holds;
  EXPECT_EQ(undetermined(holds), "");
  EXPECT_TRUE(misfits(holds).empty());
  EXPECT_TRUE(signal_faults(holds, {}, 10.0).empty());
  EXPECT_TRUE(copies(holds).empty());
}

TEST(LoadChecks, NameALoadThatWasPutOnTheWrongWayRound) {
  Holds holds = simulate(Simulated{}, 2).holds;
  const std::size_t wrong = 17;
  for (double& one : holds.holds[wrong].load) one = -one;
  const auto found = misfits(holds);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].holds, testing::ElementsAre(wrong));
  EXPECT_NEAR(found[0].ratio, -1.0, 0.05);
  EXPECT_TRUE(found[0].proportional);
}

TEST(LoadChecks, NameGramsThatWereGivenAsKilograms) {
  Holds holds = simulate(Simulated{}, 2).holds;
  const std::size_t wrong = 30;
  for (double& one : holds.holds[wrong].load) one *= 1000.0;
  const auto found = misfits(holds);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].holds, testing::ElementsAre(wrong));
  EXPECT_NEAR(found[0].ratio, 0.001, 0.0005);
}

TEST(LoadChecks, NameTheComponentAlongWhichASignalIsCurved) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_TRUE(curvatures(simulate({}, seed).holds).empty()) << "weights that are a little off are no curve";
  SimulatedHolds made = simulate({}, 1);
  constexpr std::size_t fz = 2;
  double full = 0.0;
  for (const Hold& hold : made.holds.holds) full = std::max(full, std::abs(hold.load[fz]));
  for (Hold& hold : made.holds.holds) {
    const double share = hold.load[fz] / full;
    hold.signal[fz] += 0.2 * share * share * share;  // of ten volts
  }
  const std::vector<Curvature> found = curvatures(made.holds);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].component, fz);
  EXPECT_GT(found[0].largest, 0.003 * full);
  EXPECT_LT(found[0].largest, 0.02 * full);
  EXPECT_LE(found[0].at_full_scale, found[0].largest);
}

TEST(LoadChecks, NameADeadSignal) {
  Holds holds = simulate(Simulated{}, 3).holds;
  for (Hold& hold : holds.holds) hold.signal[3] = 0.25;
  const auto found = signal_faults(holds, {}, no_end);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].signal, 3U);
  EXPECT_EQ(found[0].kind, SignalFault::Kind::dead);
}

TEST(LoadChecks, NameTheRowsOfASaturatedSignal) {
  Holds holds = simulate(Simulated{}, 3).holds;
  std::vector<std::size_t> clipped;
  for (std::size_t i = 0; i < holds.holds.size(); ++i) {
    double& value = holds.holds[i].signal[0];
    if (value > 4.0) clipped.push_back(i);
    value = std::min(value, 4.0);
  }
  const auto found = signal_faults(holds, {}, no_end);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, SignalFault::Kind::saturated);
  EXPECT_EQ(found[0].value, 4.0);
  EXPECT_EQ(found[0].holds, clipped);
}

// The information of a load is proportional to its square: what was loaded least gains most.
/// Loads that are known exactly, without those of which `is_left_out` says so.
template <typename IsLeftOut>
Holds without(Holds holds, IsLeftOut is_left_out) {
  std::erase_if(holds.holds, is_left_out);
  holds.load_error.resize(0, 0);
  return holds;
}

TEST(LoadChecks, SuggestTheWayThatWasLoadedLeast) {
  std::size_t along_y = 0;
  const Holds holds = without(simulate(Simulated{}, 4).holds,
                              [&](const Hold& hold) { return hold.load[1] != 0.0 && ++along_y > 1; });
  std::vector<Candidate> ways = six_ways();
  const std::vector<double> full{40.0, 40.0, 120.0, 2.0, 2.0, 2.0};
  for (std::size_t k = 0; k < 6; ++k) ways[k].load[k] = full[k];
  const auto next = next_load(holds, ways);
  ASSERT_TRUE(next.has_value());
  EXPECT_EQ(next->candidate, 1U);
  EXPECT_GT(next->gain, 2.0);
}

TEST(LoadChecks, SuggestWhatIsMissing) {
  const Holds holds =
      without(simulate(Simulated{}, 4).holds, [](const Hold& hold) { return hold.load[5] != 0.0; });
  EXPECT_EQ(undetermined(holds), "no load along tz: add one");
  EXPECT_EQ(next_load(holds, six_ways())->candidate, 5U);
}

TEST(LoadChecks, FindCopiesOfARow) {
  Holds holds = simulate(Simulated{}, 5).holds;
  holds.holds[9] = holds.holds[4];
  EXPECT_THAT(copies(holds), testing::ElementsAre(testing::Pair(4, 9)));
}

}  // namespace
}  // namespace kerf::fitting::calibration
