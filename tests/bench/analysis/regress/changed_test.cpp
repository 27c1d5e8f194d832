#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/version.h>

#include "bench/analysis/regress/small_suite.h"
#include "regress/inputs.h"
#include "regress/run.h"

// Only what has changed: everything that forces follow from has to be seen.

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class Inputs : public testing::Test {
 protected:
  Inputs() {
    const Suite suite = read_suite(folder_.suite());
    write_update(suite, plan_update(suite, {}), "first forces");
    stored_ = schema::read_regression(suite.stored).front();
  }
  [[nodiscard]] CaseInputs now() const {
    AskedVersions versions;
    return inputs_of(read_suite(folder_.suite()).cases.front(), versions);
  }
  /// As they are, by a program of which all is known.
  [[nodiscard]] std::string changed() const {
    CaseInputs inputs = now();
    inputs.unseen.clear();
    return changed_since(inputs, stored_);
  }
  test::SuiteFolder folder_;
  schema::StoredForces stored_;
};

TEST_F(Inputs, AreLawTrajectoryAndProgram) {
  EXPECT_THAT(changed(), IsEmpty());
  std::string text = test::one_case;
  folder_.write_suite(text.replace(text.find("exact = true"), 12, "jnd = 1"));
  EXPECT_THAT(changed(), IsEmpty()) << "the same forces are within any tolerance";
  folder_.change_law("value = 8,", "value = 8.1,");
  EXPECT_EQ(changed(), "the law or the renderer has changed");
  folder_.change_law("value = 8.1,", "value = 8,");
  text = test::one_case;
  folder_.write_suite(text.replace(text.find("value = 35"), 10, "value = 34"));
  EXPECT_EQ(changed(), "the trajectory has changed");
  folder_.write_suite(test::one_case);
  stored_.software = "kerf 0.0.1 (0123456789ab)";
  EXPECT_THAT(changed(), HasSubstr("kerf 0.0.1 (0123456789ab) stored the forces"));
}

TEST_F(Inputs, OfWhichSomeAreNotSeenAreNotTakenToBeTheSame) {
  CaseInputs inputs = now();
  inputs.unseen = "the program is none of the suite's folder";
  EXPECT_EQ(changed_since(inputs, stored_), inputs.unseen);
}

constexpr const char* renderer_case = R"(
[[case]]
name = "spring"
renderer = { command = ["./spring.sh", "{trajectory}", "{forces}"] }
axes = [{ name = "x", position = "m", force = "N" }]
seconds = { value = 20, unit = "ms" }
exact = true
[[case.motion]]
axis = "x"
kind = "sine"
centre = { value = 0, unit = "mm" }
amplitude = { value = 1, unit = "mm" }
)";

TEST(ChangedRuns, LeaveOutARendererUntilItsProgramChanges) {
  const test::SuiteFolder folder;
  const std::string script =
      "#!/bin/sh\nawk -F, 'NR==1{print \"time[s],fx[N]\"} NR>1{print $2 \",\" 300*$3}' \"$1\" > \"$2\"\n";
  test::write_text(folder.at("spring.sh"), script);
  std::filesystem::permissions(folder.at("spring.sh"), std::filesystem::perms::owner_all);
  folder.write_suite(renderer_case);
  const auto kerf = [&](const std::string& action, const std::vector<std::string>& more) {
    return folder.regress(action, more);
  };
  ASSERT_EQ(kerf("update", {"--reason", "first", "--yes"}).exit_status, 0);
  const test::Outcome same = kerf("run", {"--changed", "--json", "--junit", folder.at("r.xml")});
  EXPECT_EQ(same.exit_status, 0) << same.output;
  const auto one = nlohmann::json::parse(same.output).at("cases").at(0);
  EXPECT_TRUE(one.at("left_out").get<bool>());
  EXPECT_TRUE(one.at("passed").is_null()) << "nobody knows";
  EXPECT_THAT(test::read_text(folder.at("r.xml")), HasSubstr("skipped=\"1\""));
  EXPECT_THAT(kerf("run", {"--changed"}).output, HasSubstr("1 of 1 cases left out"));
  test::write_text(folder.at("spring.sh"), std::string(script).replace(script.find("300"), 3, "301"));
  const test::Outcome changed = kerf("run", {"--changed"});
  EXPECT_EQ(changed.exit_status, 1) << changed.output;
  EXPECT_EQ(kerf("update", {"--changed", "--reason", "x"}).exit_status, 2) << "it is of 'run'";
}

}  // namespace
}  // namespace kerf::bench
