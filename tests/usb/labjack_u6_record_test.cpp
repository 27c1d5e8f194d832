#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "emulator.h"
#include "support/program.h"
#include "u6_bench.h"

namespace kerf::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(U6, TakesOverAStreamThatAnotherProgramLeftRunning) {
  const TemporaryFolder folder;
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  // Killed at work, it stops nothing.
  const auto killed = run({"timeout", "-s", "KILL", "1.5", KERF_PROGRAM, "record", "--device", "sim:pose6",
                           "--sensor", sensor, "--seconds", "20", "-o", folder / "killed.h5"});
  EXPECT_NE(killed.exit_status, 0);
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 500);
  EXPECT_GT(measured(seen), 490U);
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
  EXPECT_EQ(figure(*device, "checksum_errors"), 0.0);
}

TEST(U6, JoinsARecordingOnItsClock) {
  const TemporaryFolder folder;
  const Emulator emulator("u6?drift=80ppm");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto outcome = run_kerf({"record", "--device", "sim:scissors", "--sensor", sensor, "--seconds", "3",
                                 "--json", "-o", folder / "joined.h5"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("\"device_figures\""), HasSubstr("\"clock_drift\"")));
  EXPECT_TRUE(schema::validate(folder / "joined.h5").empty());
  const auto recording = schema::read_recording(folder / "joined.h5");
  ASSERT_EQ(recording.force_measured.size(), 2 * recording.rows());
  EXPECT_NEAR(std::get<double>(recording.header.device_properties.at("clock_drift_ppm")), 80.0, 5.0);
  EXPECT_EQ(std::get<double>(recording.header.device_properties.at("scans_lost")), 0.0);
  EXPECT_THAT(recording.header.device_toml, HasSubstr("[sensor]"));
  const auto drift = std::ranges::find_if(
      recording.events, [](const auto& event) { return event.text.starts_with("clock_drift 8"); });
  ASSERT_NE(drift, recording.events.end());
  EXPECT_EQ(drift->kind, "device");
  ASSERT_EQ(recording.channels.size(), 2U);
  double largest = 0.0;
  for (std::size_t row = 50; row < recording.rows(); ++row) {
    ASSERT_TRUE(std::isfinite(recording.force_measured[2 * row])) << row;
    // tz of 0.4 N·m on a lever of 36.94 mm.
    largest = std::max(largest, std::abs(recording.force_measured[2 * row]));
  }
  EXPECT_NEAR(largest, 0.4 / 0.03694, 0.01);
  for (const auto& channel : recording.channels) {
    if (channel.name == "force_age") {
      for (std::size_t row = 50; row < recording.rows(); ++row) ASSERT_LE(channel.values[row], 0.0021) << row;
    } else {
      EXPECT_EQ(channel.name, "force_scan");
      EXPECT_NEAR(channel.values.back() - channel.values[100], static_cast<double>(recording.rows() - 101),
                  2.0);
    }
  }
}

TEST(U6, ThatIsUnpluggedEndsARecordingThatIsKept) {
  const TemporaryFolder folder;
  const Emulator emulator("u6", {"--seconds", "2"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto outcome = run_kerf({"record", "--device", "sim:scissors", "--sensor", sensor, "--seconds", "20",
                                 "-o", folder / "cut-off.h5"});
  EXPECT_EQ(outcome.exit_status, 3) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("the device was lost"));
  EXPECT_TRUE(schema::validate(folder / "cut-off.h5").empty());
  const auto recording = schema::read_recording(folder / "cut-off.h5");
  EXPECT_EQ(recording.header.status, "aborted: the device was lost");
  EXPECT_GT(recording.rows(), 500U);
}

TEST(U6, ThatPausesIsAGapAndNoFaultOfTheDevice) {
  const TemporaryFolder folder;
  const Emulator emulator("u6?overflow=1s");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto outcome =
      run_kerf({"check", KERF_SOURCE_DIR "/examples/kelvin.law.toml", "--device", "sim:scissors", "--sensor",
                sensor, "--seconds", "2", "--floor", "0", "--record", folder / "gap.h5", "--json"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("\"device_fault\": 0"), HasSubstr("\"overflows\"")));
  EXPECT_TRUE(schema::validate(folder / "gap.h5").empty());
  const auto recording = schema::read_recording(folder / "gap.h5");
  std::size_t gap = 0;
  std::size_t rendered = 0;
  for (std::size_t row = 500; row < recording.rows(); ++row) {
    if (std::isfinite(recording.force_measured[2 * row])) continue;
    ++gap;
    rendered += recording.force_commanded[2 * row] != 0.0 ? 1U : 0U;
  }
  EXPECT_NEAR(static_cast<double>(gap), 170.0, 10.0);
  EXPECT_EQ(rendered, gap) << "what is rendered needs no measurement";
  const auto fitted = run_kerf({"fit", folder / "gap.h5", "--models", "kelvin", "--contact", "0.5",
                                "--direction", "decreasing", "-o", folder / "fits"});
  EXPECT_THAT(fitted.errors + fitted.output, HasSubstr("rows are not finite and are left out"));
}

}  // namespace
}  // namespace kerf::test
