#include "loop/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A run of 1000 ticks of 1 ms that each compute for a while.
RunResult run_of(std::int64_t compute_ns) {
  RunResult result{.period_s = 1e-3};
  for (int tick = 0; tick < 1000; ++tick) {
    TickTimes times{.deadline_ns = 0};
    times.end_ns = {20'000, 25'000, 25'000 + compute_ns, 26'000 + compute_ns, 26'500 + compute_ns};
    result.report.count(times, 0);
  }
  return result;
}

TEST(Verdict, PassesALawThatKeepsItsTime) {
  const Verdict verdict = judge(run_of(10'000));
  EXPECT_TRUE(verdict.passed);
  EXPECT_THAT(verdict.reasons, IsEmpty());
}

TEST(Verdict, FailsALawThatTakesMoreThanHalfThePeriod) {
  EXPECT_TRUE(judge(run_of(480'000)).passed);
  const Verdict verdict = judge(run_of(520'000));
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("the law is too slow")));
}

TEST(Verdict, ToleratesOneDeadlineInAHundredAndTellsOfIt) {
  RunResult result = run_of(10'000);
  result.report.charge(Stage::wake, 10);
  const Verdict verdict = judge(result);
  EXPECT_TRUE(verdict.passed);
  EXPECT_THAT(verdict.reasons,
              ElementsAre(HasSubstr("10 of 1010 deadlines missed, 10 of them because the machine")));
}

TEST(Verdict, FailsALateMachineWithoutBlamingTheLaw) {
  RunResult result = run_of(10'000);
  result.report.charge(Stage::wake, 50);
  const Verdict verdict = judge(result);
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("50 of them because the machine woke the loop late")));
}

TEST(Verdict, FailsOnFaults) {
  RunResult result = run_of(10'000);
  result.report.law_faults = 1;
  EXPECT_FALSE(judge(result).passed);
  result.report.law_faults = 0;
  result.report.device_faults = 2;
  EXPECT_THAT(judge(result).reasons, Contains(HasSubstr("did not answer in 2 ticks")));
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
  result.report.charge(Stage::compute, 3);
  result.report.charge(Stage::record, 2);
  const auto json = check_as_json(result, judge(result));
  EXPECT_EQ(json.at("ticks"), 1005);
  EXPECT_EQ(json.at("executed"), 1000);
  EXPECT_EQ(json.at("missed"), 5);
  EXPECT_EQ(json.at("missed_by"),
            nlohmann::ordered_json::parse(R"({"wake":0,"read":0,"compute":3,"write":0,"record":2})"));
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
