#include "kerf/drivers/protocols/labjack_t7.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kerf/drivers/streaming_force_sensors.h"
#include "support/program.h"
#include "support/running_box.h"
#include "watched_sensor.h"

namespace kerf::drivers {
namespace {

using test::RunningBox;
using test::RunningT7;
using testing::AllOf;
using testing::HasSubstr;

const std::string example_calibration = "&calibration=" KERF_SOURCE_DIR "/examples/u6.calibration.toml";

TEST(LabJackT7Protocol, APacketHasItsLengthBehindAHead) {
  const std::vector<std::uint8_t> bytes{0x00, 0x07, 0x00, 0x00, 0x00, 0x0E, 0x01, 76,   0x10, 0x00,
                                        0x00, 0x20, 0x0B, 0x7D, 0x00, 0x05, 0x82, 0xF3, 0x00, 0x01};
  ASSERT_EQ(labjack_t7::Protocol::size_of(std::span(bytes).first(8)), 20U);
  const auto packet = labjack_t7::parse(bytes);
  EXPECT_EQ(packet.backlog_bytes, 32);
  EXPECT_EQ(packet.status, labjack_t7::recovered);
  EXPECT_EQ(packet.additional, 5);
  ASSERT_EQ(packet.samples.size(), 4U);
  EXPECT_EQ(packet.sample(0), 33523);
  std::vector<std::uint8_t> other = bytes;
  other[7] = 3;
  EXPECT_FALSE(labjack_t7::Protocol::size_of(std::span(other).first(8))) << "an answer is no packet";
}

// By the maker's table: 0 V at the centre, 10.1 V at the end.
TEST(LabJackT7Protocol, CodesBecomeVoltsOnBothSidesOfTheCentre) {
  const labjack_t7::Calibration nominal;
  EXPECT_TRUE(nominal.is_plausible());
  EXPECT_EQ(nominal.volts(33523), 0.0);
  EXPECT_NEAR(nominal.volts(65535), 10.1096, 1e-4);
  EXPECT_NEAR(nominal.volts(0), -10.58676, 1e-4);
  EXPECT_FALSE((labjack_t7::Calibration{.positive_slope = 0.0}).is_plausible());
}

TEST(LabJackT7, TellsWhatActedToHalfACode) {
  const test::TemporaryFolder folder;
  std::vector<Seen> seen;
  {
    const RunningT7 running("t7?trim=5000ppm&trace=" + (folder / "trace.csv").string());
    const auto device = open_device(running.uri() + example_calibration);
    EXPECT_THAT(
        device->info().configuration,
        AllOf(HasSubstr("serial = 470000001"), HasSubstr("from its memory"), HasSubstr("rate = 1000 # Hz")));
    seen = watch(*device, ticks(400));
    EXPECT_EQ(figure(*device, "frames_lost"), 0.0);
  }
  const auto truth = measured_in(folder / "trace.csv");
  std::size_t compared = 0;
  for (const Seen& one : seen) {
    if (one.status != Status::ok) continue;
    // Half a code of 0.32 mV on each input, through the rows of the example's matrix.
    ASSERT_TRUE(is_among(truth, one.sample.force_measured, 2.2e-3, 3.6e-5, 6)) << one.scan();
    ++compared;
  }
  EXPECT_GT(compared, 100U);
  expect_growing(seen);
}

TEST(LabJackT7, CountsTheScansThatItsBufferLeftOut) {
  const RunningT7 running("t7", "drop@0.7:40");
  const auto device = open_device(running.uri() + example_calibration);
  watch(*device, [&](const auto&) { return figure(*device, "frames_lost") > 0.0; });
  EXPECT_EQ(figure(*device, "frames_lost"), 40.0);
}

TEST(LabJackT7, RecordsVoltsWithoutACalibration) {
  const RunningT7 running("t7?force=0N&torque=0Nm");
  const auto device = open_device(running.uri() + "&raw=on");
  ASSERT_EQ(device->info().channels.size(), 11U);
  EXPECT_EQ(device->info().channels.back().name, "signal_6");
  const auto seen = watch(*device, ticks(100));
  EXPECT_TRUE(std::isnan(seen.back().sample.force_measured[0]));
  EXPECT_TRUE(std::isfinite(seen.back().sample.channels[10]));
}

TEST(LabJackT7, IsLostWhereItsConnectionEnds) {
  const RunningT7 running("t7", "restart@0.7:10s");
  const auto device = open_device(running.uri() + example_calibration);
  const auto seen = watch(*device, ticks(6000));
  EXPECT_LT(seen.size(), 6000U);
}

TEST(LabJackT7, IsRefusedWithWhatIsWrongAndWhatMendsIt) {
  const RunningT7 running;
  EXPECT_THAT(refusal_to_open(running.uri()), HasSubstr("name the transducer's calibration"));
  EXPECT_THAT(refusal_to_open("t7:127.0.0.1?port=1" + example_calibration),
              HasSubstr("no other program has it"));
  const RunningBox box("net-ft");
  EXPECT_THAT(refusal_to_open(fmt::format("t7:127.0.0.1?port={}{}", box.http_port(), example_calibration)),
              HasSubstr("t7:127.0.0.1"));
  const auto first = open_device(running.uri() + example_calibration);
  EXPECT_THAT(refusal_to_open(running.uri() + example_calibration), HasSubstr("another program"));
}

}  // namespace
}  // namespace kerf::drivers
