#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "support/kelvin_law.h"
#include "support/program.h"

// Devices and sensors by the names of a bench file, as a user gives them.

namespace kerf {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class BenchNames : public testing::Test {
 protected:
  BenchNames() {
    test::write_text(folder_ / "bench.toml",
                     "[device.arm]\nuri = 'sim:pose6'\nsensor = 'wrist'\noptions = { noise = false }\n"
                     "[device.blade]\nuri = 'sim:scissors'\noptions = { seed = 3 }\n"
                     "[device.lost]\nuri = 'woody-v4:/nowhere/tty'\n"
                     "[sensor.plain]\nuri = 'sim:sensor'\noptions = { calibration = 'w.toml' }\n"
                     "[sensor.wrist]\nuri = 'sim:sensor'\noptions = { calibration = 'w.toml' }\n"
                     "[sensor.wrist.frame]\nrotation = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]\n"
                     "tool = { value = [20, 0, 0], unit = 'mm' }\n");
    std::filesystem::copy_file(KERF_SOURCE_DIR "/examples/u6.calibration.toml", folder_ / "w.toml");
    setenv("KERF_BENCH", at("bench.toml").c_str(), 1);
  }
  ~BenchNames() override { unsetenv("KERF_BENCH"); }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] schema::Recording recorded(std::vector<std::string> more) const {
    const std::vector<std::string> words{"record",  "--virtual", "--seconds", "0.2",
                                         "--force", "-o",        at("r.h5")};
    more.insert(more.begin(), words.begin(), words.end());
    const test::Outcome outcome = test::run_kerf(std::move(more));
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    return schema::read_recording(at("r.h5"));
  }

  test::TemporaryFolder folder_;
};

TEST_F(BenchNames, RecordASensorInTheDevicesAxesAboutTheTip) {
  const schema::Recording plain = recorded({"--device", "none", "--sensor", "plain"});
  const schema::Recording turned = recorded({"--device", "arm"});
  ASSERT_EQ(turned.time.size(), plain.time.size());
  ASSERT_EQ(turned.axes.size(), 6U);
  for (const std::size_t row : {0UL, 57UL, turned.time.size() - 1}) {
    const auto own = [&](std::size_t axis) { return plain.force_measured.at(6 * row + axis); };
    // t - r x f with r = (0.02, 0, 0), whose r x f is (0, -0.02 fz, 0.02 fy); then z, x, y.
    const std::vector<double> expected{
        own(2), own(0), own(1), own(5) - 0.02 * own(1), own(3), own(4) + 0.02 * own(2)};
    for (std::size_t axis = 0; axis < 6; ++axis)
      EXPECT_NEAR(turned.force_measured.at(6 * row + axis), expected.at(axis), 1e-12) << row << " " << axis;
  }
  EXPECT_EQ(turned.header.device_uri, "sim:pose6?noise=off&seed=1");
  EXPECT_THAT(
      turned.header.device_toml,
      AllOf(
          HasSubstr("bench = { name = \"arm\", file = "), HasSubstr("bench = { name = \"wrist\", file = "),
          HasSubstr("sensor_frame = { rotation = [[0, 0, 1], [1, 0, 0], [0, 1, 0]], tool = [0.02, 0, 0] }")));
}

TEST_F(BenchNames, LeaveTheSensorOutWhereItIsAskedFor) {
  EXPECT_THAT(recorded({"--device", "arm", "--sensor", "none"}).header.device_toml,
              testing::Not(HasSubstr("[sensor]")));
}

TEST_F(BenchNames, AreDevicesToEveryVerb) {
  EXPECT_EQ(recorded({"--device", "blade?seed=4"}).header.device_uri, "sim:scissors?seed=4");
  test::write_text(folder_ / "k.law.toml", test::kelvin_law);
  const auto result = [](std::vector<std::string> words) {
    words.emplace_back("--json");
    return nlohmann::json::parse(test::run_kerf(std::move(words)).output);
  };
  EXPECT_EQ(
      result({"check", at("k.law.toml"), "--device", "blade", "--virtual", "--seconds", "0.2"}).at("device"),
      "sim:scissors?seed=3");
  EXPECT_EQ(result({"devices", "--probe", "blade"}).at("device"), "sim:scissors?seed=3");
}

// A frame is of forces, and what is calibrated are signals.
TEST_F(BenchNames, CalibrateASensorWithoutItsFrame) {
  const std::string loads = KERF_SOURCE_DIR "/examples/calibration/loads.toml";
  const test::Outcome outcome = test::run_kerf({"calibrate", "wrist", "--loads", loads, "--hands-free", "1",
                                                "--gravity", "9.81", "-o", at("found.calibration.toml")});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(test::read_text(at("found.json")), HasSubstr("sim:sensor?calibration="));
}

TEST_F(BenchNames, ThatAreNotThereEndWithThree) {
  const test::Outcome outcome = test::run_kerf({"record", "--virtual", "--device", "leg", "-o", at("r.h5")});
  EXPECT_EQ(outcome.exit_status, 3);
  EXPECT_THAT(outcome.errors,
              AllOf(HasSubstr("no device 'leg' in " + at("bench.toml")), HasSubstr("arm, blade")));
  EXPECT_FALSE(std::filesystem::exists(at("r.h5")));
}

TEST_F(BenchNames, AreListedWithWhatIsSeenOfThem) {
  const auto bench = nlohmann::json::parse(test::run_kerf({"devices", "--json"}).output).at("bench");
  EXPECT_EQ(bench.at("file"), at("bench.toml"));
  std::map<std::string, std::string> states;
  for (const auto& entry : bench.at("entries")) states[entry.at("name")] = entry.at("state");
  EXPECT_EQ(states, (std::map<std::string, std::string>{{"arm", "simulated"},
                                                        {"blade", "simulated"},
                                                        {"lost", "not there"},
                                                        {"plain", "simulated"},
                                                        {"wrist", "simulated"}}));
  EXPECT_THAT(test::run_kerf({"devices"}).output, HasSubstr("there is no port /nowhere/tty"));
  test::write_text(folder_ / "bench.toml", "[device.arm]\nurl = 'sim:axis'\n");
  const test::Outcome wrong = test::run_kerf({"devices"});
  EXPECT_EQ(wrong.exit_status, 0);
  EXPECT_THAT(wrong.output, AllOf(HasSubstr("bench.toml:2: unknown key 'url'"), HasSubstr("sim:scissors")));
}

}  // namespace
}  // namespace kerf
