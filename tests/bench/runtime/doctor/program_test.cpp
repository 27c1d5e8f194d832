#include "support/program.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// kerf doctor as a user runs it. How it ends depends on the machine: with 0 or 1 by its own verdict.

namespace kerf {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;

int status_of(const json& told) { return told.at("verdict") == "holds" ? 0 : 1; }

TEST(DoctorProgram, EndsAsItsVerdictSays) {
  const Outcome outcome = run_kerf({"doctor", "--seconds", "0.6", "--json"});
  const json told = json::parse(outcome.output);
  EXPECT_EQ(outcome.exit_status, status_of(told)) << outcome.errors;
  EXPECT_EQ(told.at("loop").at("ticks"), 600);
  EXPECT_TRUE(told.at("device").is_null());
  EXPECT_LE(told.at("late_wakes_explained"), told.at("late_wakes"));
  for (const json& finding : told.at("findings")) {
    EXPECT_THAT(finding.at("state").get<std::string>(), testing::AnyOf("good", "costs", "unknown"));
    EXPECT_NE(finding.at("seen"), "");
    EXPECT_NE(finding.at("where"), "");
    EXPECT_NE(finding.at("cost_why"), "") << finding;
    if (finding.at("state") == "costs") {
      EXPECT_NE(finding.at("mend"), "") << finding;
    }
  }
}

TEST(DoctorProgram, SaysItsVerdictInTheLastLine) {
  const Outcome outcome = run_kerf({"doctor", "--seconds", "0.2", "--rate", "500"});
  const std::string text = outcome.output.substr(0, outcome.output.size() - 1);
  const std::string line = text.substr(text.rfind('\n') + 1);
  EXPECT_THAT(line, testing::AllOf(HasSubstr("500 Hz"), HasSubstr("of 100 deadlines"))) << outcome.errors;
  EXPECT_EQ(outcome.exit_status, line.starts_with("this machine holds") ? 0 : 1);
}

TEST(DoctorProgram, TimesADevice) {
  const Outcome outcome = run_kerf({"doctor", "sim:scissors", "--seconds", "0.2", "--json"});
  const json told = json::parse(outcome.output);
  EXPECT_EQ(told.at("device").at("uri"), "sim:scissors");
  EXPECT_EQ(told.at("device").at("ticks"), 200);
  EXPECT_GT(told.at("device").at("read_us").at("max"), 0.0);
  EXPECT_TRUE(told.at("device").contains("report_age_us"));
}

TEST(DoctorProgram, ADeviceThatCannotBeOpenedIsADeviceError) {
  const Outcome outcome = run_kerf({"doctor", "sim:nothing"});
  EXPECT_EQ(outcome.exit_status, 3);
  EXPECT_THAT(outcome.errors, HasSubstr("sim:nothing"));
  EXPECT_EQ(outcome.output, "");
}

TEST(DoctorProgram, ARateOutOfReachIsBadInput) {
  EXPECT_EQ(run_kerf({"doctor", "--rate", "20000"}).exit_status, 2);
  EXPECT_EQ(run_kerf({"doctor", "--seconds", "0"}).exit_status, 2);
}

TEST(DoctorProgram, CtrlCSaysWhatWasSeenSoFar) {
  // An hour is not measured in full when timeout(1) asks after four seconds.
  const Outcome outcome = test::run({"timeout", "--preserve-status", "-s", "INT", "4", KERF_PROGRAM, "doctor",
                                     "--seconds", "3600", "--json"});
  const json told = json::parse(outcome.output);
  EXPECT_EQ(told.at("stopped"), true);
  EXPECT_EQ(outcome.exit_status, status_of(told)) << outcome.errors;
}

}  // namespace
}  // namespace kerf
