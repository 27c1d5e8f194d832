#include "support/program.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

// A scene as a user runs it.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string scenes = std::string(KERF_SOURCE_DIR) + "/examples/scenes/";

class SceneProgram : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Outcome record(std::vector<std::string> more) const {
    more.insert(more.begin(), {"record", "--virtual", "-o", at("r.h5"), "--force"});
    return run_kerf(more);
  }
  test::TemporaryFolder folder_;
};

TEST_F(SceneProgram, GivesTheDeviceAndHowLongItTakes) {
  const Outcome outcome = record({"--scene", scenes + "scalpel-t2.scene.toml"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, Not(HasSubstr("warning")));
  const schema::Recording recording = schema::read_recording(at("r.h5"));
  EXPECT_EQ(recording.rows(), 2400U) << "one round";
  EXPECT_THAT(recording.header.device_uri,
              AllOf(HasSubstr("sim:pose6?noise=off&path=0s"), HasSubstr("repeat=on")));
  EXPECT_THAT(recording.header.scene_toml, HasSubstr("scalpel, path T2"));
}

TEST_F(SceneProgram, StandsBackForADeviceThatIsNamedAndSaysSoInOneLine) {
  const Outcome outcome = record({"--scene", scenes + "scissors-tendon.scene.toml", "--device",
                                  "sim:scissors?close=10deg", "--seconds", "2"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors,
              HasSubstr("with --device sim:scissors?close=10deg the scene's device sim:scissors, "
                        "hand, trajectory do not apply"));
  EXPECT_THAT(schema::read_recording(at("r.h5")).header.device_uri, Not(HasSubstr("600N/m")));
}

TEST_F(SceneProgram, LetsALawBeFeltInPlaceOfItsTissue) {
  const Outcome outcome = run_kerf({"check", "--scene", scenes + "palpation.scene.toml", "--virtual",
                                    "--seconds", "2", "--record", at("c.h5")});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const schema::Recording recording = schema::read_recording(at("c.h5"));
  double pushed = 0.0;
  double touched = 0.0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    pushed = std::max(pushed, recording.force_commanded[6 * row + 2]);
    touched = std::max(touched, recording.force_measured[6 * row + 2]);
  }
  EXPECT_GT(pushed, 2.0) << "up, out of the tissue";
  EXPECT_LT(touched, 0.2) << "the tissue itself is not there";
}

TEST_F(SceneProgram, IsNeededForACheckWithoutALaw) {
  const Outcome outcome = run_kerf({"check", "--virtual", "--seconds", "1"});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("give a LAW file, or a --scene"));
}

TEST_F(SceneProgram, RefusesASceneByItsLine) {
  test::write_text(at("bad.toml"), "[tissue]\nmodel = \"blade\"\nposition_unit = \"m\"\n");
  const Outcome outcome = record({"--scene", at("bad.toml")});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("bad.toml:"));
}

}  // namespace
}  // namespace kerf
