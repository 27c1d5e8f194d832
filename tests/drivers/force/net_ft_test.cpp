#include "network/net_ft.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kerf/drivers/sensed_device.h"
#include "kerf/drivers/streaming_force_sensors.h"
#include "support/program.h"
#include "support/running_box.h"
#include "watched_sensor.h"

namespace kerf::drivers {
namespace {

using test::RunningBox;
using testing::AllOf;
using testing::HasSubstr;

/// Opens it so that its numbers are those of the records: it is asked again where the first take 100 ms to
/// come.
std::unique_ptr<Device> open_at_once(const std::string& uri) {
  std::unique_ptr<Device> device;
  for (int attempt = 0; attempt < 5; ++attempt) {
    device.reset();  // it serves one
    device = open_device(uri);
    if (figure(*device, "restarts") == 0.0) break;
  }
  return device;
}

/// The rate that its file has [Hz]: what it was told, or what arrived where that is half a percent off, as it
/// may be of a box that another program keeps from its work.
double rate_of(const Device& device) {
  const std::string& file = device.info().configuration;
  const std::string name = "\nrate = ";
  const std::size_t at = file.find(name);
  return at == std::string::npos ? 0.0 : std::stod(file.substr(at + name.size()));
}
constexpr double rate_tolerance = 0.02;

/// The wrenches of its last read-out by the number of the record, and behind each whether it left.
std::map<std::uint64_t, std::vector<double>> trace_of(const std::filesystem::path& trace) {
  std::map<std::uint64_t, std::vector<double>> all;
  for (const auto& row : rows_of(trace)) {
    if (row[0] == 1.0) all.clear();
    all[static_cast<std::uint64_t>(row[0])].assign(row.begin() + 3, row.end());
  }
  return all;
}

// Records keep their numbers from the box to the row, and a count is a millionth of a newton.
TEST(NetFt, TellsTheWrenchOfEachRecordByItsPage) {
  const test::TemporaryFolder folder;
  std::vector<Seen> seen;
  {
    const RunningBox box("net-ft?trace=" + (folder / "trace.csv").string());
    const auto device = open_at_once(box.uri());
    EXPECT_EQ(device->info().model, "Emulated Net F/T");
    EXPECT_EQ(device->info().serial, "FT00001");
    EXPECT_TRUE(device->info().measures_force);
    EXPECT_THAT(device->info().configuration,
                AllOf(HasSubstr("filter = \"0\""), HasSubstr("tool_transform = \"0;0;0;0;0;0\""),
                      HasSubstr("resample = \"latest\"")));
    EXPECT_NEAR(rate_of(*device), 1000.0, 1000.0 * rate_tolerance);
    seen = watch(*device, ticks(500));
    EXPECT_EQ(figure(*device, "frames_lost"), 0.0);
    EXPECT_EQ(figure(*device, "restarts"), 0.0);
  }
  const auto truth = trace_of(folder / "trace.csv");
  std::size_t compared = 0;
  for (const Seen& one : seen) {
    if (one.status != Status::ok) continue;
    const auto found = truth.find(one.scan());
    ASSERT_NE(found, truth.end()) << one.scan();
    for (std::size_t i = 0; i < max_axes; ++i)
      ASSERT_NEAR(one.sample.force_measured[i], found->second[i], 0.51e-6);
    ++compared;
  }
  EXPECT_GT(compared, 100U);
}

TEST(NetFt, AtPoundsAndInchesIsInNewtonsAllTheSame) {
  const test::TemporaryFolder folder;
  std::vector<Seen> seen;
  {
    const RunningBox box("net-ft?force_unit=lbf&torque_unit=lbf-in&rate=7000Hz&trace=" +
                         (folder / "trace.csv").string());
    const auto device = open_at_once(box.uri());
    EXPECT_NEAR(rate_of(*device), 7000.0, 7000.0 * rate_tolerance);
    seen = watch(*device, ticks(200));
  }
  const auto truth = trace_of(folder / "trace.csv");
  std::size_t compared = 0;
  for (const Seen& one : seen) {
    if (one.status != Status::ok) continue;
    for (std::size_t i = 0; i < max_axes; ++i)
      ASSERT_NEAR(one.sample.force_measured[i], truth.at(one.scan())[i], 3e-6);
    ++compared;
  }
  EXPECT_GT(compared, 50U);
}

// Each tick says how many were lost before its record, and the box which it left out.
TEST(NetFt, CountsEachRecordThatWasLost) {
  const test::TemporaryFolder folder;
  std::vector<Seen> seen;
  {
    const RunningBox box("net-ft?loss=0.05&seed=4&trace=" + (folder / "trace.csv").string());
    const auto device = open_at_once(box.uri());
    seen = watch(*device, ticks(800));
    EXPECT_EQ(figure(*device, "duplicates"), 0.0);
  }
  std::map<std::uint64_t, double> lost_before;
  double lost = 0.0;
  for (const auto& [number, row] : trace_of(folder / "trace.csv")) {
    lost += row.back() == 0.0 ? 1.0 : 0.0;
    lost_before[number] = lost;
  }
  std::size_t compared = 0;
  for (const Seen& one : seen) {
    if (std::isnan(one.sample.channels[1])) continue;
    ASSERT_EQ(one.sample.channels[2], lost_before.at(one.scan())) << one.scan();
    ++compared;
  }
  EXPECT_GT(compared, 700U);
  EXPECT_GT(seen.back().sample.channels[2], 10.0);
  expect_growing(seen);
}

TEST(NetFt, DropsWhatComesTwiceOrTooLate) {
  const RunningBox box("net-ft", "duplicate@0.6:20,swap@0.7:15");
  const auto device = open_device(box.uri());
  const auto seen = watch(*device, [&](const auto& all) {
    return all.size() > 300 && figure(*device, "duplicates") + figure(*device, "out_of_order") >= 35.0;
  });
  EXPECT_EQ(figure(*device, "duplicates"), 20.0);
  EXPECT_EQ(figure(*device, "out_of_order"), 15.0);  // of two that are swapped one comes too late
  expect_growing(seen);
}

TEST(NetFt, AnOverloadedSensorTellsNoForce) {
  const RunningBox box("net-ft", "overload@0.6:0.2s");
  const auto device = open_device(box.uri());
  std::size_t overloaded = 0;
  std::size_t after = 0;
  const auto seen = watch(*device, [&](const auto& all) {
    if (all.empty()) return false;
    const bool is = all.back().sample.channels[4] == 0x80020000;
    overloaded += is ? 1 : 0;
    after += !is && overloaded > 0 && all.back().status == Status::ok ? 1 : 0;
    return after > 20;
  });
  EXPECT_GT(overloaded, 20U);
  EXPECT_GT(after, 20U);
  EXPECT_GT(figure(*device, "overloads"), 100.0);
  for (const Seen& one : seen) {
    if (one.sample.channels[4] == 0x80020000) {
      EXPECT_EQ(one.status, Status::fault);
      EXPECT_TRUE(std::isnan(one.sample.force_measured[0]));
    }
  }
}

TEST(NetFt, ACountThatStandsIsNoMeasurement) {
  const RunningBox box("net-ft", "stick@0.6:0.1s");
  const auto device = open_device(box.uri());
  watch(*device, [&](const auto&) { return figure(*device, "standing_frames") >= 50.0; });
  EXPECT_GE(figure(*device, "standing_frames"), 50.0);
}

TEST(NetFt, GoesOnAfterABoxThatWasWithoutPowerForAMoment) {
  const RunningBox box("net-ft", "restart@0.8:0.3s");
  const auto device = open_device(box.uri());
  const auto seen = watch(*device, [&](const auto& all) {
    return figure(*device, "restarts") > 0.0 && all.back().status == Status::ok && all.size() > 500;
  });
  EXPECT_EQ(figure(*device, "restarts"), 1.0);
  expect_growing(seen);
  // A third of a second is missing, and its records are counted by the clock.
  EXPECT_GT(figure(*device, "frames_lost"), 250.0);
}

TEST(NetFt, IsLostASecondAfterItsLastRecord) {
  const RunningBox box("net-ft", "unplug@0.6");
  const auto device = open_device(box.uri());
  const auto seen = watch(*device, ticks(9000));
  EXPECT_LT(seen.size(), 9000U);
  Sample sample;
  EXPECT_EQ(device->read(10.0, sample), Status::lost);
  EXPECT_EQ(device->write({}), Status::lost);
}

TEST(NetFt, AnEndlessRowOfWrongSizesIsAnotherProtocol) {
  const RunningBox box("net-ft", "corrupt@0.6:100000");
  const auto device = open_device(box.uri());
  watch(*device, ticks(9000));
  Sample sample;
  EXPECT_EQ(device->read(10.0, sample), Status::lost);
  EXPECT_GE(figure(*device, "wrong_frames"), 10.0);
}

TEST(NetFt, ABoxThatIsToldToTakesWhatItReadsForNothing) {
  for (const char* stops : {"on", "off"}) {
    const RunningBox box(fmt::format("net-ft?stops_at_bias={}&force=0N&torque=0Nm", stops));
    const auto device = open_device(box.uri() + "&bias=on");
    EXPECT_THAT(device->info().configuration,
                AllOf(HasSubstr("bias_taken = true"), HasSubstr("gauge_bias = \"0;0;0;0;0;0\"")));
    EXPECT_FALSE(watch(*device, ticks(50)).empty()) << stops;
  }
}

TEST(NetFt, AnEtherDaqIsSetToItsRateAndFilter) {
  const RunningBox box("onrobot");
  const auto device = open_device(box.uri() + "&filter=2&rate=500Hz");
  EXPECT_THAT(device->info().configuration,
              AllOf(HasSubstr("filter = \"150 Hz\""), HasSubstr("counts_per_n = 10000")));
  EXPECT_NEAR(rate_of(*device), 500.0, 500.0 * rate_tolerance);
  watch(*device, ticks(300));
  EXPECT_NEAR(figure(*device, "frame_rate"), 500.0, 25.0);
}

TEST(NetFt, MeasuresForAnyDeviceAndAlone) {
  const RunningBox box("net-ft");
  {
    const auto both = open_device("sim:scissors", box.uri() + "&axes=theta:-tz/36.9mm,x_s:fx", {});
    Sample sample;
    for (int tick = 0; tick < 200; ++tick) {
      ASSERT_EQ(both->read(1e-3 * tick, sample), Status::ok);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(std::isfinite(sample.force_measured[0]));
  }
  const auto alone = open_device("none", box.uri(), {});
  EXPECT_EQ(alone->info().axes.size(), 6U);
  EXPECT_THROW((void)open_device("none", "", {}), DeviceError);
  EXPECT_THROW((void)open_device("none", "sim:axis?sensor=off", {}), DeviceError);
}

TEST(NetFt, IsRefusedWithWhatIsWrongAndWhatMendsIt) {
  const RunningBox box("net-ft");
  EXPECT_THAT(refusal_to_open("net-ft:"), HasSubstr("at which address"));
  EXPECT_THAT(refusal_to_open("net-ft:no.such.host.invalid"), HasSubstr("net-ft:no.such.host.invalid: "));
  EXPECT_THAT(refusal_to_open("net-ft:127.0.0.1?http=1"),
              AllOf(HasSubstr("netftapi2.xml"), HasSubstr("page=off")));
  EXPECT_THAT(refusal_to_open("net-ft:127.0.0.1?page=off"), HasSubstr("counts_per_n"));
  EXPECT_THAT(refusal_to_open("net-ft:127.0.0.1?page=off&counts_per_n=1&counts_per_nm=1&rate=1000Hz&port=1"),
              HasSubstr("nobody listens at UDP port 1"));
  EXPECT_THAT(refusal_to_open(fmt::format("net-ft:127.0.0.1?http={}&port=1", box.http_port())),
              HasSubstr("nobody listens"));
  EXPECT_THAT(refusal_to_open(box.uri() + "&rate=500Hz"), HasSubstr("500 were told"));
  EXPECT_THAT(refusal_to_open(box.uri() + "&delay=2ms"), HasSubstr("resample=interpolated"));
  EXPECT_THAT(refusal_to_open(box.uri() + "&colour=red"), HasSubstr("has no option 'colour'"));
  EXPECT_THAT(refusal_to_open("onrobot:127.0.0.1?rate=300Hz"), HasSubstr("whole number of milliseconds"));
  const auto first = open_device(box.uri());
  EXPECT_THAT(refusal_to_open(box.uri()), HasSubstr("another program"));
}

TEST(NetFt, ABoxThatSaysNothingIsWaitedForAndRefused) {
  const RunningBox box("net-ft?boot=1000s");
  EXPECT_THAT(refusal_to_open(box.uri()), HasSubstr("no answer within"));
  EXPECT_THAT(refusal_to_open(box.uri() + "&page=off&counts_per_n=1&counts_per_nm=1&rate=1000Hz"),
              HasSubstr("it sends nothing"));
}

TEST(NetFt, APageWithoutCountsIsRefused) {
  const RunningBox box("net-ft?counts_per_force=0");
  EXPECT_THAT(refusal_to_open(box.uri()), HasSubstr("<cfgcpf> is '0'"));
}

// On a busy machine a box may be late a quarter of a second at a time: more of its records tell.
TEST(NetFt, WhatItNotesOfItsOwnClockIsItsDrift) {
  const RunningBox box("net-ft?drift=200ppm");
  const auto device = open_device(box.uri());
  const auto is_found = [&](const auto&) {
    return std::abs(figure(*device, "clock_drift") - 200.0) <=
           std::min(3.0 * figure(*device, "clock_drift_error") + 1.0, 100.0);
  };
  EXPECT_TRUE(is_found(watch(*device, is_found)));
}

}  // namespace
}  // namespace kerf::drivers
