#include "doctor/judgement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "doctor/facts/finding.h"

namespace kerf::bench::doctor {
namespace {

Watched with_misses(std::uint64_t executed, std::uint64_t late_ticks, std::uint64_t each) {
  Watched watched;
  watched.rate_hz = 1000.0;
  watched.loop.executed = executed;
  for (std::uint64_t tick = 0; tick < late_ticks; ++tick) {
    watched.loop.charge({.tick = 50 * tick, .deadlines = each, .cause = Cause::machine});
  }
  return watched;
}

TEST(DoctorJudges, NoMissInThreeThousandHolds) {
  const RateJudgement judgement = judge(with_misses(3000, 0, 1));
  EXPECT_EQ(judgement.holds, Holds::holds);
  // scipy.stats.chi2.ppf(0.975, 2) / 2 = 3.688879
  EXPECT_NEAR(judgement.upper_share, 3.688879 / 3000.0, 1e-9);
  EXPECT_EQ(judgement.lower_share, 0.0);
}

TEST(DoctorJudges, AFewTicksAreNotEnoughToTell) {
  EXPECT_EQ(judge(with_misses(300, 0, 1)).holds, Holds::cannot_be_said) << "3.69 of 300 may have been missed";
  EXPECT_EQ(judge(with_misses(0, 0, 1)).holds, Holds::cannot_be_said);
  EXPECT_THAT(judge(with_misses(0, 0, 1)).line, testing::HasSubstr("cannot be said"));
}

TEST(DoctorJudges, AClumpCountsOnce) {
  // Of 10,000 deadlines 10 late ticks of 5 each: scipy.stats.chi2.ppf(0.025, 20) / 2 = 4.795389,
  // chi2.ppf(0.975, 22) / 2 = 18.390356.
  const RateJudgement judgement = judge(with_misses(9950, 10, 5));
  EXPECT_NEAR(judgement.missed_share, 5e-3, 1e-12);
  EXPECT_NEAR(judgement.lower_share, 5.0 * 4.795389 / 10'000.0, 1e-9);
  EXPECT_NEAR(judgement.upper_share, 5.0 * 18.390356 / 10'000.0, 1e-9);
  EXPECT_EQ(judgement.holds, Holds::holds);
}

TEST(DoctorJudges, BetweenTheLimitsNothingIsSaid) {
  EXPECT_EQ(judge(with_misses(9900, 10, 10)).holds, Holds::cannot_be_said) << "1 %, by 95 % 0.5 to 1.8 %";
  EXPECT_EQ(judge(with_misses(9000, 1000, 1)).holds, Holds::does_not_hold);
  EXPECT_THAT(judge(with_misses(9000, 1000, 1)).line,
              testing::HasSubstr("does not hold 1000 Hz: an empty loop missed 1000 of 10000 deadlines"));
}

TEST(DoctorJudges, WhatIsUnknownIsNotExplained) {
  Watched watched = with_misses(3000, 0, 1);
  watched.late_wakes = 3;
  watched.explained = {{.wake = {}, .cause = WakeCause::process, .by = ""},
                       {.wake = {}, .cause = WakeCause::unknown, .by = ""},
                       {.wake = {}, .cause = WakeCause::steal, .by = ""}};
  EXPECT_EQ(judge(watched).explained, 2U);
  EXPECT_THAT(judge(watched).line, testing::HasSubstr("of 3 late wake-ups a cause was seen for 2"));
}

TEST(DoctorFindings, StandByTheirCostAndUnknownBeforeGood) {
  std::vector<Finding> findings;
  const auto add = [&](const char* name, State state, std::optional<double> us) {
    findings.push_back(
        {.name = name, .state = state, .seen = {}, .where = {}, .cost = {.us = us, .why = {}}, .mend = {}});
  };
  add("good", State::good, 900.0);
  add("unknown", State::unknown, std::nullopt);
  add("unmeasured", State::costs, std::nullopt);
  add("small", State::costs, 3.0);
  add("large", State::costs, 30.0);
  sort_by_cost(findings);
  std::vector<std::string> names;
  for (const Finding& finding : findings) names.push_back(finding.name);
  EXPECT_THAT(names, testing::ElementsAre("large", "small", "unmeasured", "unknown", "good"));
  EXPECT_TRUE(to_json(findings[2]).at("cost_us").is_null());
  EXPECT_EQ(to_json(findings[3]).at("state"), "unknown");
}

}  // namespace
}  // namespace kerf::bench::doctor
