#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <ios>
#include <iostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/sensed_device.h>

#include "emulator.h"
#include "opening.h"
#include "support/program.h"
#include "u6_bench.h"

namespace kerf::test {
namespace {

using drivers::Status;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(U6, SaysWhoItIsAndWhatMadeItsNumbers) {
  const Emulator emulator("u6?serial=360001234");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  EXPECT_EQ(device->info().model, "LabJack U6");
  EXPECT_EQ(device->info().axes.size(), 6U);
  EXPECT_TRUE(device->info().measures_force);
  EXPECT_THAT(device->info().configuration,
              AllOf(HasSubstr("serial = 360001234"), HasSubstr("firmware = \"1.46\""),
                    HasSubstr("slope = 0.000315805"), HasSubstr("provenance = "), HasSubstr("11.9")));
}

TEST(U6, IsNoForceSensorWithoutACalibration) {
  EXPECT_THAT(refusal("u6:0"), HasSubstr("u6:0?calibration=examples/u6.calibration.toml"));
  EXPECT_THAT(refusal("u6:0?calibration=/nowhere.toml"), StartsWith("bad input: /nowhere.toml"));
  EXPECT_THAT(refusal(sensor), HasSubstr("kerf-emulate"));
}

TEST(U6, RefusesTheTransducerOfAnotherLabJack) {
  const TemporaryFolder folder;
  const Emulator emulator("u6?serial=7");
  ASSERT_TRUE(becomes_attached("u6:0"));
  write_text(folder / "other.toml", "serial = 8\n" + read_text(calibration));
  EXPECT_THAT(refusal("u6:0?calibration=" + (folder / "other.toml").string()),
              AllOf(HasSubstr("serial number 8"), HasSubstr("this one has 7")));
}

TEST(U6, LosesNothingInAMinuteAndKnowsTheDriftOfItsClock) {
  const Emulator emulator("u6?drift=80ppm");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 60'000, [&](int tick) {
    if (tick == 10'000) {
      EXPECT_NEAR(figure(*device, "clock_drift"), 80.0, 5.0);
    }
  });
  EXPECT_GT(measured(seen), 59'990U);
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
  EXPECT_EQ(figure(*device, "restarts"), 0.0);
  // 80 parts in a million of 60,000 are 4.8 scans.
  EXPECT_NEAR(figure(*device, "scans"), 60'000.0 - 4.8, 3.0);
  EXPECT_NEAR(figure(*device, "scan_rate"), 1000.0 / (1.0 + 80e-6), 0.001);
  EXPECT_NEAR(figure(*device, "clock_drift"), 80.0, 1.0);
  EXPECT_LT(figure(*device, "clock_drift_error"), 1.0);
  EXPECT_LE(largest_jump(seen), 2.0);
}

TEST(U6, MeasuresTheWrenchThatActed) {
  const TemporaryFolder folder;
  // Constants 2 % off the nominal ones: those of the device's memory are what counts.
  Emulator emulator("u6?trim=20000ppm&drift=-80ppm&trace=" + (folder / "trace.csv").string());
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 2000);
  emulator.unplug();
  EXPECT_GT(measured(seen), 1990U);
  double largest = 0.0;
  for (const Seen& one : seen)
    largest = std::max(largest, one.status == Status::ok ? std::abs(one.wrench[2]) : 0.0);
  EXPECT_NEAR(largest, 8.0, 0.01);
  expect_what_acted(seen, folder / "trace.csv");
}

TEST(U6, MakesAGapOfPacketsThatAreMissing) {
  const TemporaryFolder folder;
  Emulator emulator("u6?trace=" + (folder / "trace.csv").string(), {"--fault", "drop@1.0:7"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 1500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "scans_lost"), 7.0);
  EXPECT_EQ(largest_jump(seen), 8.0);
  expect_what_acted(seen, folder / "trace.csv");
}

TEST(U6, MakesAGapOfPacketsThatWereTurnedOrTorn) {
  const TemporaryFolder folder;
  Emulator emulator("u6?trace=" + (folder / "trace.csv").string(), {"--fault", "corrupt@0.8:3,split@1.1:2"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 1500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "checksum_errors"), 3.0 + 2.0 * 2.0);
  EXPECT_EQ(figure(*device, "scans_lost"), 5.0);
  EXPECT_EQ(largest_jump(seen), 4.0);
  expect_what_acted(seen, folder / "trace.csv");
}

TEST(U6, MakesAGapOfScansThatFoundNoRoom) {
  const TemporaryFolder folder;
  Emulator emulator("u6?overflow=0.5s&trace=" + (folder / "trace.csv").string());
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 1500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "overflows"), 1.0);
  EXPECT_EQ(figure(*device, "restarts"), 0.0);
  // 984 samples are 164 scans of the 190 ms in which none left.
  EXPECT_NEAR(figure(*device, "scans_lost"), 190.0 - 164.0, 1.0);
  // From 20 ms after the last scan there is nothing to say for 170 ms.
  EXPECT_NEAR(static_cast<double>(seen.size() - measured(seen)), 170.0, 10.0);
  EXPECT_EQ(seen.back().status, Status::ok);
  expect_what_acted(seen, folder / "trace.csv");
}

TEST(U6, StartsAStalledStreamAnew) {
  const TemporaryFolder folder;
  Emulator emulator("u6?drift=80ppm&trace=" + (folder / "trace.csv").string(), {"--fault", "stall@1.8:1"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 2500);
  emulator.unplug();
  EXPECT_EQ(figure(*device, "restarts"), 1.0);
  EXPECT_EQ(seen.back().status, Status::ok);
  EXPECT_GT(measured(seen), 2400U);
  // The numbers go on as if it had not stopped: as many as milliseconds have passed.
  EXPECT_NEAR(seen.back().scan - seen[100].scan, 2399.0, 2.0);
  EXPECT_NEAR(figure(*device, "scans") + figure(*device, "scans_lost"), seen.back().scan + 1.0, 2.0);
  expect_what_acted(seen, folder / "trace.csv");
}

TEST(U6, StartsASilentStreamAnew) {
  const TemporaryFolder folder;
  // 400 packets: more than their counter counts.
  Emulator emulator("u6?trace=" + (folder / "trace.csv").string(), {"--fault", "drop@1.0:400"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 2000);
  emulator.unplug();
  EXPECT_GE(figure(*device, "restarts"), 1.0);
  EXPECT_EQ(seen.back().status, Status::ok);
  EXPECT_NEAR(seen.back().scan - seen[100].scan, 1899.0, 2.0);
  expect_what_acted(seen, folder / "trace.csv");
}

TEST(U6, IsLostWhenItIsUnpluggedAndComesBack) {
  Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  {
    const auto device = drivers::open_device(sensor);
    const auto seen = watch(*device, 500, [&](int tick) {
      if (tick == 300) emulator.unplug();
    });
    EXPECT_EQ(seen[200].status, Status::ok);
    EXPECT_EQ(seen.back().status, Status::lost);
  }
  ASSERT_TRUE(becomes_attached("u6:", false));
  const Emulator again("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  EXPECT_EQ(watch(*drivers::open_device(sensor), 100).back().status, Status::ok);
}

TEST(U6, LeavesNothingBehindTwentyTimes) {
  Held at_first;
  for (int time = 0; time < 20; ++time) {
    Emulator emulator("u6");
    ASSERT_TRUE(becomes_attached("u6:0"));
    {
      const auto device = drivers::open_device(sensor);
      const bool pulled = time % 2 == 0;
      const auto seen = watch(*device, 60, [&](int tick) {
        if (tick == 40 && pulled) emulator.unplug();
      });
      EXPECT_EQ(seen[39].status, Status::ok) << time;
    }
    if (time == 0) at_first = held();
  }
  EXPECT_EQ(held(), at_first);
}

TEST(U6, OfTwoProgramsOnlyOneHasIt) {
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  EXPECT_THAT(refusal(sensor), HasSubstr("in use by another program"));
}

TEST(U6, SaysHowToObtainThePermission) {
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const AsNobody guard;
  EXPECT_THAT(refusal(sensor),
              AllOf(HasSubstr("no permission for /dev/bus/usb"), HasSubstr("70-kerf.rules")));
}

TEST(U6, MeasuresBesideADeviceThatMeasuresNothing) {
  const Emulator cap("spacemouse");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));  // two at once would want the same port
  const Emulator emulator("u6");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device("spacemouse:0", sensor, {});
  EXPECT_TRUE(device->info().measures_force);
  drivers::Sample last;
  loop(*device, 300, [&](int, Status status, const drivers::Sample& sample) {
    EXPECT_EQ(status, Status::ok);
    last = sample;
  });
  for (const double force : last.force_measured) EXPECT_NE(force, 0.0);
  EXPECT_GT(last.channels[3], 250.0) << "force_scan, behind report_age, buttons and force_age";
  EXPECT_GT(figure(*device, "report_rate"), 0.0);
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
}

// tests/usb/same-twice runs it in two guests: what it writes must be the same to the last bit.
TEST(U6Twice, SeesTheSameEachTime) {
  const char* folder = std::getenv("KERF_TWICE");
  if (folder == nullptr) GTEST_SKIP() << "KERF_TWICE names no folder";
  const Emulator emulator("u6?noise=2&drift=33ppm", {"--fault", "drop@0.6:2"});
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  const auto seen = watch(*device, 800);
  EXPECT_EQ(figure(*device, "scans_lost"), 2.0);
  std::ofstream file(std::string(folder) + "/scans");
  file << std::hexfloat;
  for (const Seen& one : seen) {
    file << one.age_s << ' ' << one.scan;
    for (const double force : one.wrench) file << ' ' << force;
    file << '\n';
  }
}

// By the clock on the wall.

TEST(U6Rate, LosesNothingInTenSeconds) {
  const Emulator emulator("u6?drift=80ppm");
  ASSERT_TRUE(becomes_attached("u6:0"));
  const auto device = drivers::open_device(sensor);
  double longest_s = 0.0;
  auto last = std::chrono::steady_clock::now();
  const auto seen = watch(*device, 10'000, [&](int) {
    const auto now = std::chrono::steady_clock::now();
    longest_s = std::max(longest_s, std::chrono::duration<double>(now - last).count());
    last = now;
  });
  std::cout << "scans " << figure(*device, "scans") << ", lost " << figure(*device, "scans_lost")
            << "; the machine stood still for up to " << longest_s << " s\n";
  if (longest_s > 0.15) GTEST_SKIP() << "too long for the emulator's buffer of 0.164 s";
  EXPECT_EQ(figure(*device, "scans_lost"), 0.0);
  // By when the first and the last arrived in these ten seconds, each as late as the machine stood still.
  EXPECT_NEAR(figure(*device, "scan_rate"), 1000.0 / (1.0 + 80e-6), 0.5 + 100.0 * longest_s);
  // A guest on a busy machine wakes late by tenths of a millisecond; it knows by itself how well it knows.
  EXPECT_NEAR(figure(*device, "clock_drift"), 80.0,
              std::max(5.0, 2.0 * figure(*device, "clock_drift_error")));
  std::vector<double> ages;
  for (const Seen& one : seen) {
    if (one.status == Status::ok) ages.push_back(one.age_s);
  }
  std::ranges::sort(ages);
  ASSERT_FALSE(ages.empty());
  std::cout << "force_age: median " << 1e3 * ages[ages.size() / 2] << " ms, 99 % "
            << 1e3 * ages[ages.size() * 99 / 100] << " ms; drift " << figure(*device, "clock_drift") << " +- "
            << figure(*device, "clock_drift_error") << " ppm\n";
}

}  // namespace
}  // namespace kerf::test
