#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/mechanisms/falcon.h>

#include "emulator.h"
#include "falcon_bench.h"
#include "opening.h"
#include "support/allocation_counter.h"
#include "support/program.h"

namespace kerf::test {
namespace {

using drivers::Sample;
using drivers::Status;
using mechanisms::Falcon;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double wall_z = 0.125;
constexpr double wall_n_per_m = 400.0;

/// Pushes out what is pressed deeper than the wall, and a little sideways.
drivers::Axes wall(const Sample& sample) {
  const double depth = std::max(0.0, wall_z - sample.position[2]);
  return {0.3 * wall_n_per_m * depth, -0.2 * wall_n_per_m * depth, wall_n_per_m * depth};
}

TEST(Falcon, LoadsItsFirmwareIsHomedAndFollowsTheHand) {
  const TemporaryFolder folder;
  Emulator emulator("falcon?offset=500&glitch=on&trace=" + (folder / "trace.csv").string());
  ASSERT_TRUE(becomes_attached("falcon:0"));
  std::vector<Eigen::Vector3d> seen;
  {
    const auto device = drivers::open_device("falcon:0?firmware=" + firmware_file(folder));
    EXPECT_EQ(device->info().model, "Novint Falcon");
    ASSERT_EQ(device->info().axes.size(), 3U);
    EXPECT_THAT(device->info().configuration,
                AllOf(HasSubstr("torque_scale = 10000"), HasSubstr("6616"), HasSubstr("3500 to 5500")));
    bool pressed = false;
    loop(*device, 2000, [&](int tick, Status status, const Sample& sample) {
      EXPECT_EQ(status, Status::ok);
      EXPECT_LT(sample.channels[4], 0.0033);
      pressed |= sample.channels[0] == 4.0;
      if (tick < 1000) return;  // the hand returns from homing
      seen.emplace_back(sample.position[0], sample.position[1], sample.position[2]);
    });
    EXPECT_TRUE(pressed);
  }
  emulator.unplug();
  // What was seen is where the knob really was in some frame, one after the other.
  const auto trace = read_trace(folder / "trace.csv");
  auto frame = trace.begin();
  Eigen::AlignedBox3d range;
  for (const Eigen::Vector3d& knob : seen) {
    frame = std::find_if(frame, trace.end(), [&](const TraceRow& row) {
      return (Eigen::Vector3d(row.knob.data()) - knob).cwiseAbs().maxCoeff() < 1e-4;
    });
    ASSERT_NE(frame, trace.end());
    range.extend(knob);
  }
  EXPECT_GT(range.sizes().minCoeff(), 0.001);
}

TEST(Falcon, KeepsItsFirmwareAndItsHomeUntilItIsUnplugged) {
  const TemporaryFolder folder;
  const Emulator emulator("falcon");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  (void)drivers::open_device("falcon:0?firmware=" + firmware_file(folder));
  const auto device = drivers::open_device("falcon:0?homing_timeout=0.1s");
  loop(*device, 50, [](int, Status status, const Sample&) { EXPECT_EQ(status, Status::ok); });
}

TEST(Falcon, ItsLightIsRedUntilItIsHomedAndThenAsAskedFor) {
  const TemporaryFolder folder;
  Emulator emulator("falcon?firmware=loaded&trace=" + (folder / "trace.csv").string());
  ASSERT_TRUE(becomes_attached("falcon:0"));
  { const auto device = drivers::open_device("falcon:0?led=blue"); }
  emulator.unplug();
  auto trace = read_trace(folder / "trace.csv");
  ASSERT_GT(trace.size(), 10U);
  EXPECT_TRUE(std::ranges::all_of(trace, &TraceRow::homing));  // without a gap
  EXPECT_EQ(trace.back().led, "off");                          // the last word
  trace.pop_back();
  const auto red = [](const TraceRow& row) { return row.led == "red"; };
  const auto blue =
      std::find_if_not(trace.begin() + 1, trace.end(), red);  // the first one only asks who is there
  EXPECT_NEAR(blue->time_s - trace.front().time_s, 0.3, 0.01);
  EXPECT_TRUE(std::all_of(blue, trace.end(), [](const TraceRow& row) { return row.led == "blue"; }));
}

TEST(Falcon, CountsFromWherePowerFoundItWithoutHoming) {
  const Emulator emulator("falcon?firmware=loaded&sway=0m");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0?homing=off");
  // Zero counts are arms at 35 degrees each.
  const auto expected = Falcon::knob(Falcon::shoulder_of({0, 0, 0}), {0.0, 0.0, 0.12});
  ASSERT_TRUE(expected);
  loop(*device, 100, [&](int, Status status, const Sample& sample) {
    EXPECT_EQ(status, Status::ok);
    EXPECT_NEAR(sample.position[2], expected->z(), 1e-4);
  });
}

TEST(Falcon, SaysWhichFirmwareIsMissing) {
  const TemporaryFolder folder;
  const Emulator emulator("falcon");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  EXPECT_THAT(refusal("falcon:0"), AllOf(HasSubstr("no firmware loaded"), HasSubstr("falcon:0?firmware=FILE"),
                                         HasSubstr("Kerf ships none")));
  EXPECT_THAT(refusal("falcon:0?firmware=" + (folder / "nothing.bin").string()),
              AllOf(StartsWith("bad input: "), HasSubstr("cannot be read (No such file")));
  write_text(folder / "page.html", "<html>");
  EXPECT_THAT(refusal("falcon:0?firmware=" + (folder / "page.html").string()),
              HasSubstr("does not begin with the key 0x08AA"));
  EXPECT_THAT(refusal("falcon:1"), HasSubstr("number 1 is not attached (1 of 0403:cb48 found)"));
  EXPECT_THAT(refusal("falcon:0?led=pink"), HasSubstr("expected red, green, blue or off"));
}

TEST(Falcon, SaysWhatTheLoaderDoesNotAnswer) {
  const TemporaryFolder folder;
  const Emulator emulator("falcon", {"--fault", "drop@0:1000000"});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  EXPECT_THAT(refusal("falcon:0?firmware=" + firmware_file(folder)),
              HasSubstr("does not answer at 9600 baud"));
}

TEST(Falcon, LoadsItsFirmwareAgainWhereAByteWasLostOrTurned) {
  const TemporaryFolder folder;
  // 40 kB take 2.9 s: each fault is within a try.
  const Emulator emulator("falcon?homed=on", {"--fault", "corrupt@1.5,flip@3.5:1:5,drop@6"});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0?homing=off&firmware=" + firmware_file(folder, 20000));
  loop(*device, 100, [](int, Status status, const Sample&) { EXPECT_EQ(status, Status::ok); });
}

TEST(Falcon, ComparesWhatTheLoaderSendsBackAndGivesUpAfterTenTries) {
  const TemporaryFolder folder;
  std::string faults;
  for (int tries = 0; tries < 10; ++tries) faults += "flip@" + std::to_string(tries + 1) + ".5:1,";
  faults.pop_back();
  const Emulator emulator("falcon", {"--fault", faults});
  ASSERT_TRUE(becomes_attached("falcon:0"));
  EXPECT_THAT(refusal("falcon:0?firmware=" + firmware_file(folder, 20000)),
              AllOf(HasSubstr("of its firmware back wrong"), HasSubstr("(tried 10 times)")));
}

TEST(Falcon, AHomingThatIsLostAtOnceIsNone) {
  const Emulator emulator("falcon?firmware=loaded&home_after=0.05s&home_for=0.0005s");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  EXPECT_THAT(refusal("falcon:0?homing_timeout=0.3s"), HasSubstr("not homed within 0.3 s"));
}

TEST(Falcon, WaitsForHomingOnlySoLongAndOnlyWhileSomebodyWaits) {
  const Emulator emulator("falcon?firmware=loaded&home_after=100s");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  EXPECT_THAT(refusal("falcon:0?homing_timeout=0.3s"),
              AllOf(HasSubstr("not homed within 0.3 s"), HasSubstr("homing=off")));
  std::atomic<bool> stop{false};
  std::thread impatient([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop = true;
  });
  EXPECT_THAT(refusal("falcon:0", &stop), HasSubstr("interrupted"));
  impatient.join();
}

TEST(Falcon, ForcesArriveAsTheRightMotorNumbers) {
  const TemporaryFolder folder;
  Emulator emulator("falcon?firmware=loaded&homed=on&trace=" + (folder / "trace.csv").string());
  ASSERT_TRUE(becomes_attached("falcon:0"));
  struct Asked {
    Eigen::Vector3d knob;
    Eigen::Vector3d force;
  };
  std::vector<Asked> asked;
  {
    const auto device = drivers::open_device("falcon:0");
    loop(*device, 1000, [&](int, Status status, const Sample& sample) {
      EXPECT_EQ(status, Status::ok);
      const drivers::Axes force = wall(sample);
      EXPECT_EQ(device->write(force), Status::ok);
      asked.push_back(
          {{sample.position[0], sample.position[1], sample.position[2]}, {force[0], force[1], force[2]}});
    });
    EXPECT_NEAR(figure(*device, "report_rate"), 1000.0, 20.0);
    EXPECT_EQ(figure(*device, "resent"), 0.0);
    EXPECT_EQ(figure(*device, "dropped_bytes"), 0.0);
  }
  emulator.unplug();
  // Every frame carries V = -K tau of one of the ticks, in their order, to the nearest unit; some ticks are
  // skipped.
  const auto trace = read_trace(folder / "trace.csv");
  std::size_t matched = 0;
  std::size_t next = 0;
  double max_degrees = 0.0;
  for (const TraceRow& row : trace) {
    const auto begin = asked.begin() + static_cast<std::ptrdiff_t>(next);
    const auto end = asked.begin() + static_cast<std::ptrdiff_t>(std::min(asked.size(), next + 4));
    const auto found = std::find_if(begin, end, [&](const Asked& one) {
      const Eigen::Vector3d torque = Falcon::torques(one.force, *Falcon::angles(one.knob));
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(row.raw[i] + 10000.0 * torque[static_cast<Eigen::Index>(i)]) > 0.5001) return false;
      }
      return true;
    });
    if (found == end) continue;
    next = static_cast<std::size_t>(found - asked.begin()) + 1;
    ++matched;
    if (found->force.norm() < 1.0) continue;
    const Eigen::Vector3d torque = -Eigen::Vector3d(row.raw[0], row.raw[1], row.raw[2]) / 10000.0;
    const Eigen::Vector3d felt = Falcon::force(torque, *Falcon::angles(found->knob));
    max_degrees = std::max(max_degrees, std::atan2(felt.cross(found->force).norm(), felt.dot(found->force)) *
                                            180.0 / std::numbers::pi);
  }
  EXPECT_GT(matched, 980U);
  EXPECT_LT(trace.size() - matched, 20U);  // zeros before the first tick and after the last
  EXPECT_GT(max_degrees, 0.0);
  EXPECT_LT(max_degrees, 0.1);
}

TEST(Falcon, TheWallHoldsTheHandWhereTheSpringsSay) {
  const Emulator emulator("falcon?firmware=loaded&homed=on&sway=0m");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  double z = 0.0;
  // 2 N outward against a hand of 300 N/m: 6.67 mm, but for 0.1 N of friction.
  loop(*device, 1500, [&](int, Status, const Sample& sample) {
    EXPECT_EQ(device->write({0.0, 0.0, 2.0}), Status::ok);
    z = sample.position[2];
  });
  EXPECT_NEAR(z, 0.12 + 2.0 / 300.0, 0.1 / 300.0 + 0.00005);
}

TEST(Falcon, LetsGoWhenReleasedForgottenOrAskedForNonsense) {
  const TemporaryFolder folder;
  Emulator emulator("falcon?firmware=loaded&homed=on&trace=" + (folder / "trace.csv").string());
  ASSERT_TRUE(becomes_attached("falcon:0"));
  {
    const auto device = drivers::open_device("falcon:0");
    Sample sample;
    const auto pass = [&](int milliseconds) {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      (void)device->read(0.0, sample);
      return std::max(
          {std::abs(sample.channels[1]), std::abs(sample.channels[2]), std::abs(sample.channels[3])});
    };
    EXPECT_EQ(pass(10), 0.0);  // nothing was asked for yet
    EXPECT_EQ(device->write({0.0, 0.0, 4.0}), Status::ok);
    EXPECT_GT(pass(5), 900.0);
    device->release(0.0);
    EXPECT_EQ(pass(3), 0.0);
    EXPECT_EQ(device->write({0.0, 0.0, 4.0}), Status::ok);
    EXPECT_GT(pass(45), 900.0);
    EXPECT_EQ(pass(10), 0.0);  // 50 ms without a command
    EXPECT_EQ(device->write({0.0, 0.0, 4.0}), Status::ok);
    EXPECT_GT(pass(5), 900.0);
    EXPECT_EQ(device->write({0.0, std::nan(""), 0.0}), Status::fault);
    EXPECT_EQ(pass(5), 0.0);
    EXPECT_EQ(device->write({std::numeric_limits<double>::infinity(), 0.0, 0.0}), Status::fault);
    EXPECT_EQ(pass(5), 0.0);
    EXPECT_EQ(device->write({9.0, 9.0, 0.0}), Status::ok);  // more than the motors have
    EXPECT_EQ(pass(5), 4095.0);
    EXPECT_NE(sample.faults, 0U);
    EXPECT_EQ(figure(*device, "motor_limited"), 1.0);
  }
  emulator.unplug();
  const auto trace = read_trace(folder / "trace.csv");
  ASSERT_FALSE(trace.empty());
  EXPECT_THAT(trace.back().raw, testing::ElementsAre(0, 0, 0));  // said at the end
}

TEST(Falcon, OfTwoProgramsOnlyOneHasIt) {
  const Emulator emulator("falcon?firmware=loaded&homed=on");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  EXPECT_THAT(refusal("falcon:0"), HasSubstr("in use by another program; close that program"));
}

TEST(Falcon, SaysHowToObtainThePermission) {
  const Emulator emulator("falcon?firmware=loaded&homed=on");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const AsNobody guard;
  EXPECT_THAT(refusal("falcon:0"),
              AllOf(HasSubstr("no permission for /dev/bus/usb/"), HasSubstr("70-kerf.rules")));
}

TEST(Falcon, TheTickAllocatesNothing) {
  const Emulator emulator("falcon?firmware=loaded&homed=on");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  const auto device = drivers::open_device("falcon:0");
  loop(*device, 200, [&](int tick, Status, const Sample&) {
    const NoAllocation guard;
    Sample sample;
    (void)device->read(1e-3 * tick, sample);
    (void)device->write(wall(sample));
    device->release(0.0);
  });
}

}  // namespace
}  // namespace kerf::test
