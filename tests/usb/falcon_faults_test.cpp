#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "emulator.h"
#include "falcon_bench.h"
#include "opening.h"
#include "support/program.h"

namespace kerf::test {
namespace {

using drivers::Sample;
using drivers::Status;

constexpr const char* ready = "falcon?firmware=loaded&homed=on";

/// A loop with a wall for so long that faults of its first second are in it; how many ticks were not well.
struct Losses {
  int faults = 0;
  int lost = 0;
  double resent = 0.0;
  double dropped_bytes = 0.0;
  double malformed = 0.0;
  double reports = 0.0;
};
Losses run_with(const std::string& faults) {
  const Emulator emulator(ready, {"--fault", faults});
  EXPECT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  Losses run;
  loop(*device, 700, [&](int, Status status, const Sample& sample) {
    run.faults += status == Status::fault;
    run.lost += status == Status::lost;
    (void)device->write({0.0, 0.0, 400.0 * std::max(0.0, 0.12 - sample.position[2])});
  });
  run.resent = figure(*device, "resent");
  run.dropped_bytes = figure(*device, "dropped_bytes");
  run.malformed = figure(*device, "malformed");
  run.reports = figure(*device, "reports");
  return run;
}

TEST(Falcon, AsksAgainWhereAnAnswerIsLost) {
  const Losses run = run_with("drop@0.7,drop@0.8,drop@0.9");
  EXPECT_EQ(run.faults, 0);  // 5 ms are not yet stale
  EXPECT_EQ(run.resent, 3.0);
  EXPECT_EQ(run.dropped_bytes, 0.0);
  EXPECT_GT(run.reports, 650.0);
}

TEST(Falcon, PutsATornAnswerTogether) {
  const Losses run = run_with("split@0.7,split@0.8,split@0.9");
  EXPECT_EQ(run.faults, 0);
  EXPECT_EQ(run.resent, 0.0);
  EXPECT_EQ(run.dropped_bytes, 0.0);
}

TEST(Falcon, FindsItsFramesAgainAfterALostByte) {
  const Losses run = run_with("corrupt@0.7,corrupt@0.8,corrupt@0.9");
  EXPECT_EQ(run.faults, 0);
  EXPECT_EQ(run.resent, 3.0);
  EXPECT_EQ(run.dropped_bytes, 3.0 * 15.0);
}

// What the counts say is for the loop to judge; but a velocity that a turned bit made would outlast it by 8
// ms.
TEST(Falcon, ATurnedBitMakesNoVelocity) {
  std::string faults;
  for (int i = 0; i < 60; ++i) faults += fmt::format("flip@{:.2f}:1:{},", 0.8 + 0.02 * i, i);
  faults.pop_back();
  const Emulator emulator(ready, {"--fault", faults});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  int moved = 0;
  double fastest = 0.0;
  drivers::Axes last{};
  loop(*device, 1700, [&](int tick, Status status, const Sample& sample) {
    EXPECT_NE(status, Status::lost);
    if (tick > 0) moved += std::abs(sample.position[2] - last[2]) > 1e-3;
    last = sample.position;
    if (tick > 50) fastest = std::max(fastest, std::abs(sample.velocity[2]));
    (void)device->write({0.0, 0.0, 0.1});
  });
  // 10 mm at 0.59 Hz are 37 mm/s; a jump that a hand can make as well is up to 0.4 mm, an eighth of which
  // counts.
  EXPECT_LT(fastest, 0.09);
  EXPECT_GE(moved, 6) << "higher bits of the counts were among them, and came back";
}

TEST(Falcon, LetsGoAndEndsWhileAFrameIsRefused) {
  const TemporaryFolder folder;
  const std::string file = folder / "trace.csv";
  {
    const Emulator emulator(std::string(ready) + "&sway=0m&trace=" + file, {"--fault", "refuse-out@1:0.8s"});
    ASSERT_TRUE(becomes_attached("falcon:0"));
    const auto device = drivers::open_device("falcon:0");
    int faults = 0;
    loop(*device, 1000, [&](int, Status status, const Sample&) {
      faults += status != Status::ok;
      (void)device->write({0.0, 0.0, 1.0});
    });
    EXPECT_GT(faults, 100) << "it answers nothing";
    device->release(0.0);
    loop(*device, 1000, [](int, Status, const Sample&) {});
  }
  const auto rows = read_trace(file);
  bool refused = false;
  for (std::size_t i = 1; i < rows.size() && !refused; ++i) {
    refused = rows[i].time_s - rows[i - 1].time_s > 0.5;
    if (refused) {
      EXPECT_NE(rows[i - 1].motor, (std::array{0, 0, 0}));
      EXPECT_EQ(rows[i].motor, (std::array{0, 0, 0}));
    }
  }
  EXPECT_TRUE(refused);
  // And a program that ends meanwhile does not wait for it.
  const Emulator again(ready, {"--fault", "refuse-out@1:100s"});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  auto device = drivers::open_device("falcon:0");
  loop(*device, 900, [&](int, Status, const Sample&) { (void)device->write({0.0, 0.0, 1.0}); });
  const auto asked = std::chrono::steady_clock::now();
  device.reset();
  EXPECT_LE(std::chrono::steady_clock::now() - asked, std::chrono::milliseconds(100));
}

TEST(Falcon, ALateAnswerIsAsOldAsItsQuestion) {
  const Emulator emulator(ready, {"--fault", "delay@0.8:4ms:0.2s"});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  double oldest = 0.0;
  double last = 0.0;
  loop(*device, 1200, [&](int, Status status, const Sample& sample) {
    EXPECT_EQ(status, Status::ok);
    oldest = std::max(oldest, sample.age_s);
    last = sample.age_s;
    (void)device->write({0.0, 0.0, 0.1});
  });
  EXPECT_GE(oldest, 0.004);
  EXPECT_LE(last, 0.002);
}

TEST(Falcon, GoesOnAfterAStall) {
  const Losses run = run_with("stall@0.8:3");
  EXPECT_EQ(run.lost, 0);
  EXPECT_EQ(run.malformed, 3.0);
  EXPECT_GT(run.reports, 650.0);
}

TEST(Falcon, IsLostWhereItStallsForGood) {
  const Losses run = run_with("stall@0.8:1000000");
  EXPECT_GT(run.lost, 100);
}

TEST(Falcon, ASilentOneIsAtFaultAndThenLost) {
  const Emulator emulator(ready, {"--fault", "drop@0.6:1000000"});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  int first_fault = -1;
  int first_lost = -1;
  double oldest = 0.0;
  loop(*device, 1500, [&](int tick, Status status, const Sample& sample) {
    if (status == Status::ok) oldest = std::max(oldest, sample.channels[4]);
    if (status == Status::fault && first_fault < 0) first_fault = tick;
    if (status == Status::lost && first_lost < 0) first_lost = tick;
    (void)device->write({});
  });
  ASSERT_GE(first_fault, 0);
  EXPECT_LE(oldest, 0.02);
  EXPECT_NEAR(first_lost - first_fault, 980, 2);
}

TEST(Falcon, IsLostWhenItIsUnpluggedAndComesBack) {
  Emulator emulator(ready);
  ASSERT_TRUE(becomes_attached("falcon:0"));
  {
    const auto device = drivers::open_device("falcon:0");
    Status last = Status::ok;
    loop(*device, 400, [&](int tick, Status status, const Sample&) {
      if (tick == 200) emulator.unplug();
      last = status;
      (void)device->write({0.0, 0.0, 1.0});
    });
    EXPECT_EQ(last, Status::lost);
    EXPECT_EQ(device->write({}), Status::lost);
  }
  ASSERT_TRUE(becomes_attached("falcon:", false));
  EXPECT_THROW((void)drivers::open_device("falcon:0"), drivers::DeviceError);
  const Emulator again(ready);
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  loop(*device, 50, [](int, Status status, const Sample&) { EXPECT_EQ(status, Status::ok); });
}

TEST(Falcon, UnpluggedWhileItIsHomedItSaysSo) {
  const Emulator emulator("falcon?firmware=loaded&home_after=100s", {"--fault", "unplug@1.0"});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  EXPECT_THAT(refusal("falcon:0"), testing::HasSubstr("unplugged before it was homed"));
}

TEST(Falcon, LeavesNothingBehindHoweverOftenItIsUnplugged) {
  Held at_first;
  for (int round = 0; round < 20; ++round) {
    Emulator emulator(ready);
    ASSERT_TRUE(becomes_attached("falcon:0")) << round;
    {
      const auto device = drivers::open_device("falcon:0");
      loop(*device, 20, [&](int tick, Status, const Sample&) {
        if (tick == 10 && round % 2 == 0) emulator.unplug();  // with transfers under way, or closed before
        (void)device->write({0.0, 0.0, 1.0});
      });
    }
    emulator.unplug();
    ASSERT_TRUE(becomes_attached("falcon:", false)) << round;
    if (round == 0) at_first = held();
  }
  EXPECT_EQ(held(), at_first);
}

}  // namespace
}  // namespace kerf::test
