#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/mechanisms/falcon.h>
#include <kerf/schema/recording.h>

#include "datasets-schema/same_recording.h"
#include "emulator.h"
#include "falcon_bench.h"
#include "support/program.h"

namespace kerf::tests {
namespace {

using testing::HasSubstr;

constexpr const char* trace = "/tmp/wall-trace.csv";

/// A wall of 400 N/m at z = 0.12 m that is pressed inwards, with a viscous arm beside the spring.
std::string wall_file() {
  const std::string path = "/tmp/wall.law.toml";
  test::write_text(path, R"(model = "kelvin"
axis = "z"
position_unit = "m"
force_unit = "N"

[contact]
position = { value = 0.12, unit = "m" }
direction = "decreasing"

[parameters]
parallel_stiffness = { value = 400, unit = "N/m" }
series_stiffness = { value = 100, unit = "N/m" }
damping = { value = 2, unit = "N·s/m" }
)");
  return path;
}

/// Records the wall; the recording stays in `file`.
test::Outcome record(const std::string& file, const std::string& emulated, double seconds,
                     const std::vector<std::string>& emulator_arguments = {}) {
  Emulator emulator(emulated, emulator_arguments);
  EXPECT_TRUE(becomes_attached("falcon:0"));
  auto outcome = test::run_kerf({"record", "--device", "falcon:0?firmware=" + firmware_file(), "--law",
                                 wall_file(), "--seconds", std::to_string(seconds), "--force", "-o", file});
  emulator.unplug();
  EXPECT_TRUE(becomes_attached("falcon:", false));
  return outcome;
}

TEST(Falcon, AWallOfTenSecondsIsRecordedAndSentAsItsTorques) {
  const std::string file = "/tmp/wall.h5";
  const auto outcome = record(file, std::string("falcon?trace=") + trace, 10.0);
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_EQ(test::run_kerf({"validate", file}).exit_status, 0);
  const schema::Recording wall = schema::read_recording(file);
  EXPECT_EQ(wall.rows(), 10000U);
  ASSERT_EQ(wall.axes.size(), 3U);
  double deepest = 0.0;
  double strongest = 0.0;
  std::size_t faults = 0;
  for (std::size_t row = 0; row < wall.rows(); ++row) {
    deepest = std::max(deepest, 0.12 - wall.position[3 * row + 2]);
    strongest = std::max(strongest, wall.force_commanded[3 * row + 2]);
    faults += (wall.flags[row] & schema::flag_device_fault) != 0;
  }
  EXPECT_EQ(faults, 0U);
  // 400 N/m and a hand of 300 N/m that wants to be 10 mm behind the wall: 4.3 mm, but for the arm and the
  // motion.
  EXPECT_NEAR(deepest, 0.0043, 0.001);
  EXPECT_NEAR(strongest, 400.0 * deepest, 0.5);

  // What went over the wire are the torques of the recorded forces, in their order from the first touch on.
  const auto frames = read_trace(trace);
  const auto touch = std::ranges::find_if(frames, [](const TraceRow& one) {
    return one.raw != std::array{0, 0, 0};
  });
  auto next = static_cast<std::size_t>(touch - frames.begin());
  std::size_t sent = 0;
  std::size_t matched = 0;
  for (std::size_t row = 0; row < wall.rows(); ++row) {
    const Eigen::Vector3d knob(&wall.position[3 * row]);
    const Eigen::Vector3d torque = mechanisms::Falcon::torques(
        Eigen::Vector3d(&wall.force_commanded[3 * row]), *mechanisms::Falcon::angles(knob));
    std::array<int, 3> motor{};
    for (std::size_t i = 0; i < 3; ++i) {
      motor[i] = static_cast<int>(std::lround(-10000.0 * torque[static_cast<Eigen::Index>(i)]));
    }
    if (sent == 0 && motor == std::array{0, 0, 0}) continue;
    ++sent;
    for (std::size_t frame = next; frame < std::min(frames.size(), next + 3); ++frame) {
      if (frames[frame].raw != motor) continue;
      next = frame + 1;
      ++matched;
      break;
    }
  }
  EXPECT_GT(sent, 9000U);
  EXPECT_GT(static_cast<double>(matched), 0.99 * static_cast<double>(sent));
}

TEST(Falcon, UnpluggedWhileItIsRecordedTheRecordingIsClosedAndValid) {
  const std::string file = "/tmp/unplugged.h5";
  const auto outcome = record(file, "falcon?firmware=loaded&homed=on", 10.0, {"--fault", "unplug@2.5"});
  EXPECT_EQ(outcome.exit_status, 3);
  EXPECT_THAT(outcome.errors, HasSubstr("falcon:0"));
  EXPECT_THAT(outcome.errors, HasSubstr("the device was lost after"));
  EXPECT_EQ(test::run_kerf({"validate", file}).exit_status, 0);
  const auto recording = schema::read_recording(file);
  EXPECT_THAT(recording.header.status, HasSubstr("aborted: the device was lost"));
  ASSERT_GT(recording.rows(), 1000U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(recording.force_commanded[3 * (recording.rows() - 1) + axis], 0.0);
  }
}

TEST(Falcon, AtTheEndOfARecordingTheMotorsAreLetGo) {
  const auto outcome =
      record("/tmp/short.h5", std::string("falcon?firmware=loaded&homed=on&trace=") + trace, 2.0);
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto frames = read_trace(trace);
  ASSERT_FALSE(frames.empty());
  EXPECT_THAT(frames.back().raw, testing::ElementsAre(0, 0, 0));
  EXPECT_TRUE(std::ranges::any_of(frames, [](const TraceRow& row) { return row.raw[0] < -100; }));
}

// In a guest that the next test starts; the file outlives it.
TEST(FalconInAGuest, RecordsTheWall) {
  const char* file = std::getenv("KERF_RECORDING");
  if (file == nullptr) GTEST_SKIP() << "for FalconTwice";
  EXPECT_EQ(record(file, "falcon", 2.0).exit_status, 0);
}

// On the machine itself.
TEST(FalconTwice, RecordsTheSameInVirtualTime) {
  std::array<schema::Recording, 2> recordings;
  for (std::size_t i = 0; i < 2; ++i) {
    // The guest may write below the project's folder.
    const std::string file = KERF_BUILD_DIR "/falcon-twice-" + std::to_string(i) + ".h5";
    setenv("KERF_RECORDING", file.c_str(), 1);
    const auto outcome = test::run({KERF_USB_MACHINE, "--virtual-time", "--seconds", "100", "--",
                                    std::filesystem::read_symlink("/proc/self/exe").string(),
                                    "--gtest_filter=FalconInAGuest.*"});
    if (outcome.exit_status == 77) GTEST_SKIP() << outcome.errors;
    ASSERT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
    recordings[i] = schema::read_recording(file);
    std::filesystem::remove(file);
  }
  EXPECT_EQ(recordings[0].rows(), 2000U);
  test::expect_same_samples(recordings[0], recordings[1]);
  EXPECT_EQ(recordings[0].header.device_toml, recordings[1].header.device_toml);
}

// By the clock on the wall, of a machine that does other things too.
TEST(FalconRate, AnswersNearlyAThousandTimesASecond) {
  const Emulator emulator("falcon?firmware=loaded&homed=on");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  loop(*device, 3000, [&](int, drivers::Status, const drivers::Sample& sample) {
    (void)device->write({0.0, 0.0, 400.0 * std::max(0.0, 0.12 - sample.position[2])});
  });
  EXPECT_GE(figure(*device, "report_rate"), 900.0);
  EXPECT_LE(figure(*device, "report_rate"), 1010.0);
}

}  // namespace
}  // namespace kerf::tests
