#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/check_text.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A run of 1000 ticks of 1 ms that each compute for a while, by the clock and of processor time.
RunResult run_of(std::int64_t compute_ns, std::int64_t cpu_ns) {
  RunResult result{.period_s = 1e-3};
  for (int tick = 0; tick < 1000; ++tick) {
    TickTimes times{.deadline_ns = 0};
    times.end_ns = {20'000, 25'000, 25'000 + compute_ns, 26'000 + compute_ns, 26'500 + compute_ns};
    result.report.count(times, 0);
    result.report.compute_cpu.add(cpu_ns);
  }
  return result;
}
RunResult run_of(std::int64_t compute_ns) { return run_of(compute_ns, compute_ns); }

void charge(RunResult& result, Stage stage, std::uint64_t deadlines, Cause cause = Cause::machine) {
  result.report.charge({.deadlines = deadlines, .stage = stage, .cause = cause});
}

TEST(Verdict, PassesALawThatKeepsItsTime) {
  const Verdict verdict = judge(run_of(10'000));
  EXPECT_TRUE(verdict.passed);
  EXPECT_THAT(verdict.reasons, IsEmpty());
  EXPECT_THAT(verdict.causes, IsEmpty());
}

TEST(Verdict, FailsALawThatTakesMoreThanHalfThePeriod) {
  EXPECT_TRUE(judge(run_of(480'000)).passed);
  const Verdict verdict = judge(run_of(520'000));
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.causes, ElementsAre(Cause::law));
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("your law is too slow")));
}

TEST(Verdict, NeverCallsALawSlowThatWasMadeToWait) {
  const Verdict verdict = judge(run_of(700'000, 10'000));
  EXPECT_TRUE(verdict.passed);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("your machine was late, not your law slow")));
}

TEST(Verdict, ToleratesOneDeadlineInAHundredAndTellsOfIt) {
  RunResult result = run_of(10'000);
  charge(result, Stage::wake, 10);
  const Verdict verdict = judge(result);
  EXPECT_TRUE(verdict.passed);
  EXPECT_THAT(
      verdict.reasons,
      ElementsAre("10 of 1010 deadlines missed: 10 by wake; because of the machine 10 (it woke the loop "
                  "late, or made it wait)",
                  HasSubstr("for example tick 0: wake took")));
}

TEST(Verdict, IsNotKnownOfALawThatNeverPushed) {
  RunResult result = run_of(10'000);
  result.report.executed = 1000;
  const Verdict never = judge_law(result);
  EXPECT_FALSE(never.passed);
  EXPECT_EQ(name_of(never), not_felt);
  EXPECT_EQ(check_as_json(result, never).at("verdict"), "not known");
  EXPECT_THAT(never.reasons,
              ElementsAre(HasSubstr("the law was never felt: its force was zero in all 1000")));
  result.report.pushing = 1;
  EXPECT_EQ(name_of(judge_law(result)), "pass");
  RunResult slow = run_of(520'000);
  EXPECT_EQ(name_of(judge_law(slow)), "fail") << "it is too slow, felt or not";
}

TEST(CheckLines, ShowTheTimesOfTheJsonAStageALine) {
  RunResult result = run_of(10'000, 8'000);
  charge(result, Stage::write, 3);
  const Verdict verdict = judge(result);
  const auto lines = check_lines(result, verdict);
  ASSERT_EQ(lines.size(), 1U + 7U + verdict.reasons.size());
  const auto json = check_as_json(result, verdict);
  const std::array names{"wake", "read", "compute", "compute_cpu", "write", "record", "cycle"};
  for (std::size_t row = 0; row < names.size(); ++row) {
    const auto& times = json.at(std::string(names[row]) + "_us");
    EXPECT_THAT(lines[row + 1],
                testing::StartsWith(fmt::format("  {:11} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f}", names[row],
                                                times["mean"].get<double>(), times["p50"].get<double>(),
                                                times["p99"].get<double>(), times["p999"].get<double>(),
                                                times["max"].get<double>())));
  }
  EXPECT_THAT(lines[5], testing::EndsWith("        3")) << "deadlines missed by writing";
  EXPECT_THAT(lines.back(), HasSubstr(verdict.reasons.back()));
}

TEST(Verdict, BlamesWhoCostMostDeadlinesWhateverTheStage) {
  for (const Cause cause : {Cause::law, Cause::device, Cause::machine, Cause::unknown}) {
    RunResult result = run_of(10'000);
    charge(result, Stage::wake, 20);
    charge(result, Stage::read, 50, cause);
    const Verdict verdict = judge(result);
    EXPECT_FALSE(verdict.passed);
    EXPECT_THAT(verdict.causes, ElementsAre(cause));
  }
}
TEST(Verdict, SetsMissedDeadlinesBesideThoseOfAnEmptyLoop) {
  RunResult result = run_of(10'000);
  result.floor = HostFloor{.rate_hz = 1000.0, .ticks = 3000, .missed = 6};
  EXPECT_THAT(
      judge(result).reasons,
      ElementsAre("no deadline was missed in this run, but an empty loop missed 6 of 3000 here: expect "
                  "120 in a minute"));
  charge(result, Stage::wake, 5);
  EXPECT_THAT(judge(result).reasons, Contains(HasSubstr("these may all be the machine's own")));
  result.floor->missed = 0;
  charge(result, Stage::wake, 5);
  EXPECT_THAT(judge(result).reasons, Contains(HasSubstr("the machine was later in this run")));
  charge(result, Stage::compute, 1, Cause::law);
  EXPECT_THAT(judge(result).reasons, Contains(HasSubstr("these are more than the machine's own")));
  result.report.missed_by = {};
  result.report.late_ticks = 0;
  EXPECT_THAT(judge(result).reasons, IsEmpty()) << "a quiet machine and a quiet run";
}

TEST(Verdict, FailsOnFaultsOfLawAndDevice) {
  for (const auto& [flag, cause] :
       {std::pair{schema::flag_law_fault, Cause::law}, std::pair{schema::flag_device_fault, Cause::device},
        std::pair{schema::flag_position_jump, Cause::device}}) {
    RunResult result = run_of(10'000);
    result.report.count({}, flag);
    const Verdict verdict = judge(result);
    EXPECT_FALSE(verdict.passed);
    EXPECT_THAT(verdict.causes, ElementsAre(cause));
    EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("in 1 ticks")));
  }
}

TEST(Verdict, TellsOfEveryInterventionThatIsNoFault) {
  for (const schema::Flag flag : {schema::flag_watchdog, schema::flag_force_limited,
                                  schema::flag_slew_limited, schema::flag_passivity_control}) {
    RunResult result = run_of(10'000);
    result.report.count({}, flag);
    EXPECT_TRUE(judge(result).passed);
    EXPECT_EQ(judge(result).reasons.size(), 1U);
  }
}

TEST(Verdict, TellsOfARenderingThatIsNotPassive) {
  RunResult result = run_of(10'000);
  result.report.least_energy_j = -0.01;
  const Verdict verdict = judge(result);
  EXPECT_TRUE(verdict.passed);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("not passive")));
  EXPECT_EQ(check_as_json(result, verdict).at("passive"), false);
}

TEST(CheckAsJson, AddsUp) {
  RunResult result = run_of(10'000);
  charge(result, Stage::compute, 3, Cause::law);
  charge(result, Stage::record, 2);
  const auto json = check_as_json(result, judge(result));
  EXPECT_EQ(json.at("ticks"), 1005);
  EXPECT_EQ(json.at("executed"), 1000);
  EXPECT_EQ(json.at("missed"), 5);
  EXPECT_EQ(json.at("missed_by"),
            nlohmann::ordered_json::parse(R"({"wake":0,"read":0,"compute":3,"write":0,"record":2})"));
  EXPECT_EQ(json.at("missed_because"),
            nlohmann::ordered_json::parse(R"({"law":3,"device":0,"machine":2,"unknown":0})"));
  ASSERT_EQ(json.at("late_ticks").size(), 2U);
  EXPECT_EQ(json.at("late_ticks").at(0).at("cause"), "law");
  double sum_us = 0.0;
  for (const auto* stage : {"read_us", "compute_us", "write_us", "record_us"}) {
    sum_us += json.at(stage).at("mean").get<double>();
  }
  EXPECT_NEAR(sum_us, json.at("cycle_us").at("mean").get<double>(), 1e-9);
  EXPECT_NEAR(sum_us, 16.5, 1e-9) << "5 us, 10 us, 1 us and 0.5 us";
  const auto& histogram = json.at("histograms").at("wake_us");
  EXPECT_EQ(histogram.at("edges").size(), histogram.at("counts").size() + 1);
  EXPECT_EQ(histogram.at("counts").at(0), 1000);
}

}  // namespace
}  // namespace kerf::bench
