#include "kerf/drivers/bench_file.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kerf/drivers/sensed_device.h"
#include "kerf/drivers/uri.h"
#include "support/allocation_counter.h"
#include "support/program.h"
#include "support/running_box.h"

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string refusal_of(const std::string& text) {
  try {
    (void)parse_bench_file(text, "lab/bench.toml");
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "taken";
}

std::string uri_in(const std::string& text) {
  return parse_bench_file(text, "/lab/bench.toml").entries.at(0).uri;
}

TEST(BenchFile, MakesTheOptionsOfAUriOfItsValues) {
  EXPECT_EQ(uri_in("[sensor.wrist]\nuri = 'net-ft:192.168.1.1?http=8080'\n[sensor.wrist.options]\n"
                   "resample = 'interpolated'\ndelay = { value = 2, unit = 'ms' }\nbias = true\n"
                   "counts_per_n = 1e6\nrate = '1000Hz'\n"),
            "net-ft:192.168.1.1?bias=on&counts_per_n=1000000&delay=2ms&http=8080&rate=1000Hz&resample="
            "interpolated");
  EXPECT_EQ(uri_in("[device.a]\nuri = 'sim:axis'\noptions = { force = [1, 2.5] }\n"), "sim:axis?force=1,2.5");
}

TEST(BenchFile, TakesPathsFromItsOwnFolder) {
  EXPECT_EQ(uri_in("[sensor.w]\nuri = 'u6:0'\noptions = { calibration = 'ft/w.toml' }\n"),
            "u6:0?calibration=/lab/ft/w.toml");
  EXPECT_EQ(uri_in("[device.w]\nuri = 'plugin:./mine.so'\n"), "plugin:/lab/mine.so");
  EXPECT_EQ(uri_in("[device.w]\nuri = 'woody-v4:/dev/ttyACM0'\n"), "woody-v4:/dev/ttyACM0");
}

TEST(BenchFile, SaysInWhichLineWhatIsWrong) {
  const std::string arm = "[device.arm]\nuri = 'sim:axis'\n";
  const std::string wrist = "[sensor.wrist]\nuri = 'sim:sensor'\n";
  EXPECT_EQ(refusal_of(arm + wrist), "taken");
  const auto expect = [](const std::string& text, int line, const std::string& words) {
    EXPECT_THAT(refusal_of(text),
                AllOf(HasSubstr(fmt::format("lab/bench.toml:{}: ", line)), HasSubstr(words)));
  };
  expect("[devices.arm]\nuri = 'sim:axis'\n", 1, "unknown key 'devices' in a bench file");
  expect(arm + "rui = 1\n", 3, "unknown key 'rui' in [device.arm]; known are uri, options, sensor");
  expect(arm + "frame = {}\n", 3, "unknown key 'frame'");
  expect(arm + "sensor = 'wrist'\n", 3, "no [sensor.wrist]");
  expect("[device.arm]\nsensor = 'x'\n", 1, "'uri' is missing");
  expect("[device.arm]\nuri = 'wrist'\n", 2, "is no URI");
  expect("[device.none]\nuri = 'sim:axis'\n", 1, "is no name");
  expect("[device.'a b']\nuri = 'sim:axis'\n", 1, "is no name");
  expect("[sensor.arm]\nuri = 'sim:sensor'\n" + arm, 3, "is the name of a sensor already");
  expect("[device.a]\nuri = 'sim:axis?seed=1'\noptions = { seed = 2 }\n", 3, "stands in the URI too");
  expect(arm + "options = { seed = '1&b=2' }\n", 3, "holds '&'");
  expect(arm + "options = { 'bench.toml' = 'x' }\n", 3, "is no name of an option");
  expect(arm + "options = { seed = 2026-01-01 }\n", 3, "must be a text, a number");
  expect(wrist + "frame = {}\n", 3, "says nothing");
  expect(wrist + "frame = { rotation = [[1,0,0],[0,1,0]] }\n", 3, "three rows");
  expect(wrist + "frame = { rotation = [[1,0,0],[0,2,0],[0,0,1]] }\n", 3, "row 2 has the length 2");
  expect(wrist + "frame = { rotation = [[1,0,0],[0,1,0],[0,0,-1]] }\n", 3, "it mirrors");
  expect(wrist + "frame = { tool = { value = [0, 0, 85], unit = 'in' } }\n", 3, "expected m, cm or mm");
  expect(wrist + "frame = { tool = { value = [0, 0, 85], unit = 'm' } }\n", 3, "10 m at most");
  expect(wrist + "frame = { tool = [0, 0, 85] }\n", 3, "'tool' must be");
  expect(wrist + "frame = { tool = { value = [0, 85], unit = 'm' } }\n", 3, "must be three numbers");
  expect("[device.arm\n", 1, "");
}

TEST(BenchFile, OfTheExamplesIsOne) {
  const std::filesystem::path file = std::filesystem::path(KERF_SOURCE_DIR) / "examples/bench.toml";
  const BenchFile bench = parse_bench_file(test::read_text(file), file);
  ASSERT_NE(bench.find("wrist"), nullptr);
  ASSERT_NE(bench.find("arm"), nullptr);
  EXPECT_EQ(bench.find("arm")->sensor, "wrist");
  EXPECT_TRUE(bench.find("wrist")->frame.has_value());
  EXPECT_EQ(bench.sha256.size(), 64U);
}

/// A bench file of this test alone.
class NamedDevices : public testing::Test {
 protected:
  NamedDevices() { setenv("KERF_BENCH", file().c_str(), 1); }
  ~NamedDevices() override { unsetenv("KERF_BENCH"); }

  [[nodiscard]] std::string file() const { return (folder_ / "bench.toml").string(); }
  void write(const std::string& text) const { test::write_text(file(), text); }
  static std::string refusal(const std::string& uri) {
    try {
      (void)open_device(uri);
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "opened";
  }

  test::TemporaryFolder folder_;
};

TEST_F(NamedDevices, AreOpenedWithTheirOptionsAndSayWhereTheyStand) {
  write("[device.arm]\nuri = 'sim:scissors'\noptions = { seed = 3, noise = false }\n");
  EXPECT_EQ(named_uri("arm"), "sim:scissors?bench.toml=arm&noise=off&seed=3");
  EXPECT_EQ(named_uri("arm?seed=4&hand=off"), "sim:scissors?bench.toml=arm&hand=off&noise=off&seed=4");
  const auto device = open_device("arm?seed=4");
  EXPECT_EQ(device->info().uri, "sim:scissors?noise=off&seed=4");
  const std::string sum = parse_bench_file(test::read_text(file()), file()).sha256;
  EXPECT_THAT(device->info().configuration,
              testing::StartsWith(
                  fmt::format("bench = {{ name = \"arm\", file = '{}', sha256 = \"{}\" }}\n", file(), sum)));
  EXPECT_THAT(device->info().configuration,
              HasSubstr(open_device("sim:scissors?noise=off&seed=4")->info().configuration));
}

// Whatever the file holds, and whether it can be read at all.
TEST_F(NamedDevices, ChangeNothingOfWhatHasAColon) {
  write("this is no TOML\n");
  EXPECT_EQ(named_uri("sim:axis"), "sim:axis");
  EXPECT_EQ(named_uri("none"), "none");
  EXPECT_EQ(named_uri(""), "");
  EXPECT_EQ(open_device("sim:axis")->info().uri, "sim:axis");
  EXPECT_EQ(sensor_beside("sim:axis", ""), "");
  EXPECT_THAT(refusal("arm"), HasSubstr("bench.toml:1: "));
}

TEST_F(NamedDevices, AreRefusedWithTheNamesThatThereAre) {
  write("[device.arm]\nuri = 'sim:axis'\n[sensor.wrist]\nuri = 'sim:sensor'\n");
  EXPECT_THAT(refusal("leg"), AllOf(HasSubstr("no device 'leg' in " + file()), HasSubstr("wrist, arm")));
  std::filesystem::remove(file());
  EXPECT_THAT(refusal("arm"), AllOf(HasSubstr("KERF_BENCH=" + file()), HasSubstr("No such file")));
}

TEST_F(NamedDevices, AreLookedForHereAndThenAtHome) {
  unsetenv("KERF_BENCH");
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const std::string before = config == nullptr ? "" : config;
  setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
  const auto at_home = folder_ / "kerf" / "bench.toml";
  EXPECT_EQ(bench_file_places(), (std::vector<std::filesystem::path>{"bench.toml", at_home}));
  EXPECT_THAT(refusal("arm"),
              AllOf(HasSubstr("looked for bench.toml and " + at_home.string()), HasSubstr("KERF_BENCH")));
  std::filesystem::create_directory(folder_ / "kerf");
  test::write_text(at_home, "[device.arm]\nuri = 'sim:axis'\n");
  EXPECT_EQ(refusal("arm"), "opened");
  if (before.empty()) {
    unsetenv("XDG_CONFIG_HOME");
  } else {
    setenv("XDG_CONFIG_HOME", before.c_str(), 1);
  }
}

TEST_F(NamedDevices, BringTheSensorThatStandsBesideThem) {
  write(
      "[device.arm]\nuri = 'sim:pose6'\nsensor = 'wrist'\n[device.leg]\nuri = 'sim:pose6'\n"
      "[sensor.wrist]\nuri = 'sim:sensor'\n");
  const std::string wrist = "sim:sensor?bench.toml=wrist";
  EXPECT_EQ(sensor_beside("arm", ""), wrist);
  EXPECT_EQ(sensor_beside(named_uri("arm") + "&seed=3", ""), wrist);
  EXPECT_EQ(sensor_beside("arm", "none"), "");
  EXPECT_EQ(sensor_beside("arm", "u6:0"), "u6:0");
  EXPECT_EQ(sensor_beside("leg", "wrist"), wrist);
  EXPECT_EQ(sensor_beside("leg", ""), "");
}

/// One reading of a sensor that stands beside nothing.
Sample reading_of(const std::string& uri) {
  const auto sensor = open_device("none", uri, {});
  Sample sample;
  const test::NoAllocation none;
  EXPECT_EQ(sensor->read(0.0, sample), Status::ok);
  return sample;
}

TEST_F(NamedDevices, TellTheWrenchAboutTheTipInTheDevicesAxes) {
  const std::string calibration = KERF_SOURCE_DIR "/examples/u6.calibration.toml";
  write("[sensor.wrist]\nuri = 'sim:sensor'\noptions = { calibration = '" + calibration +
        "' }\n[sensor.wrist.frame]\nrotation = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]\n"
        "tool = { value = [0, 0, 100], unit = 'mm' }\n");
  const Axes own = reading_of("sim:sensor?calibration=" + calibration).force_measured;
  const Sample told = reading_of("wrist");
  const Axes expected{own[1], -own[0], own[2], own[4] - 0.1 * own[0], -(own[3] + 0.1 * own[1]), own[5]};
  for (std::size_t i = 0; i < max_axes; ++i) EXPECT_NEAR(told.force_measured[i], expected[i], 1e-15) << i;
  EXPECT_NE(told.channels[0], 0.0) << "signals stay the sensor's";
  const auto arm = open_device("sim:pose6", "wrist", {});
  EXPECT_THAT(
      arm->info().configuration,
      AllOf(HasSubstr("[sensor]\nuri = \"sim:sensor?calibration="), HasSubstr("\nbench = { name = \"wrist\""),
            HasSubstr(
                "\nsensor_frame = { rotation = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], tool = [0, 0, 0.1] }")));
}

TEST_F(NamedDevices, LeaveTheGapOfASensorAGap) {
  write("[sensor.wrist]\nuri = 'sim:sensor'\nframe = { tool = { value = [1, 2, 3], unit = 'cm' } }\n");
  for (const double one : reading_of("wrist").force_measured) EXPECT_TRUE(std::isnan(one));
}

TEST_F(NamedDevices, TakeABoxOfTheNetworkByItsName) {
  const test::RunningBox box("net-ft");
  write("[sensor.wrist]\nuri = '" + box.uri() +
        "'\noptions = { resample = 'interpolated', delay = '2ms' }\n");
  const auto device = open_device("none", "wrist?delay=3ms", {});
  EXPECT_THAT(device->info().configuration,
              AllOf(HasSubstr("bench = { name = \"wrist\""), HasSubstr("delay = 0.003 # s"),
                    Not(HasSubstr("sensor_frame"))));
}

TEST_F(NamedDevices, GiveNoFrameToWhatTellsNoForcesInSpace) {
  write("[sensor.wrist]\nuri = 'sim:scissors'\nframe = { tool = { value = [1, 2, 3], unit = 'cm' } }\n");
  EXPECT_THAT(refusal("wrist"), AllOf(HasSubstr("[sensor.wrist.frame]"), HasSubstr("it tells theta [N]")));
}

}  // namespace
}  // namespace kerf::drivers
