#include "support/program.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// kerf devices --probe as a user runs it.

namespace kerf {
namespace {

using test::run_kerf;
using testing::HasSubstr;

class ProbeProgram : public testing::Test {
 protected:
  ProbeProgram() { setenv("XDG_DATA_HOME", folder_.path().c_str(), 1); }
  ~ProbeProgram() override { unsetenv("XDG_DATA_HOME"); }
  [[nodiscard]] bool anything_is_kept() const { return !std::filesystem::is_empty(folder_.path()); }

  test::TemporaryFolder folder_;
};

TEST_F(ProbeProgram, FindsASimulatedDeviceRightWithoutAsking) {
  const auto outcome = run_kerf({"devices", "--probe", "sim:scissors"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, testing::ContainsRegex("theta +right"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("x_s +right .* mm/N"));
  EXPECT_EQ(outcome.errors, "");
  EXPECT_FALSE(anything_is_kept()) << "of a device that nobody has";
}

TEST_F(ProbeProgram, SaysTheSameInJson) {
  const auto outcome = run_kerf({"devices", "--probe", "sim:scissors", "--json"});
  EXPECT_EQ(outcome.exit_status, 0);
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json.at("all_right"), true);
  const auto& theta = json.at("axes").at(0);
  EXPECT_EQ(theta.at("name"), "theta");
  EXPECT_EQ(theta.at("verdict"), "right");
  EXPECT_EQ(theta.at("force_unit"), "N");
  EXPECT_NEAR(theta.at("force"), 0.758, 1e-12);
  EXPECT_GT(theta.at("moved_per_force"), 0.01);
  EXPECT_GE(theta.at("pushes"), 6);
}

TEST_F(ProbeProgram, AHandThatIsNeverStillIsACheckThatDidNotPass) {
  const auto outcome = run_kerf({"devices", "--probe", "sim:premium?grip=5000N/m&stroke=0.2s&pause=0s"});
  EXPECT_EQ(outcome.exit_status, 1) << outcome.errors;
  EXPECT_THAT(outcome.output, testing::ContainsRegex("q1 +unknown"));
}

TEST_F(ProbeProgram, NeedsSomebodyWhoHoldsTheHandle) {
  const auto outcome = run_kerf({"devices", "--probe", "falcon:0"});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("--yes"));
}

TEST_F(ProbeProgram, ADeviceThatIsNotThereIsADeviceErrorOnceSomebodyHasSaidYes) {
  const auto outcome = run_kerf({"devices", "--probe", "hid:9999:9999", "--yes"});
  EXPECT_EQ(outcome.exit_status, 3);
  EXPECT_FALSE(anything_is_kept());
}

}  // namespace
}  // namespace kerf
