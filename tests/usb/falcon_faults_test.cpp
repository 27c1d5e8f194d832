#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "emulator.h"
#include "opening.h"

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
