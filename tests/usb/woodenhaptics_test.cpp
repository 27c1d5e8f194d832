#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/drivers/device.h>
#include <kerf/mechanisms/woodenhaptics.h>

#include "emulator.h"
#include "opening.h"
#include "support/allocation_counter.h"
#include "support/program.h"
#include "woodenhaptics_bench.h"

namespace kerf::test {
namespace {

using drivers::Axes;
using drivers::Device;
using drivers::Sample;
using drivers::Status;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::size_t age_channel = 3;
constexpr std::size_t button_channel = 4;

double middle_of(const Device& device, std::size_t axis) {
  return 0.5 * (device.info().axes[axis].lower + device.info().axes[axis].upper);
}

/// A loop that commands a force at each tick.
template <typename F>
void hold(Device& device, int ticks, const Axes& force, F each) {
  loop(device, ticks, [&](int tick, Status status, const Sample& sample) {
    each(tick, status, sample);
    (void)device.write(force);
  });
}
void hold(Device& device, int ticks, const Axes& force) {
  hold(device, ticks, force, [](int, Status status, const Sample&) { EXPECT_EQ(status, Status::ok); });
}

TEST(WoodenHaptics, EachGenerationIsKnownAndFollowsItsTip) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const Emulator emulator(one.emulator);
    ASSERT_TRUE(becomes_attached(one.uri));
    const auto device = drivers::open_device(one.uri);
    EXPECT_EQ(device->info().model, one.name);
    EXPECT_EQ(device->info().channels.size(), one.channels);
    EXPECT_THAT(device->info().configuration, HasSubstr("provenance"));
    std::array<double, 3> most{-1.0, -1.0, -1.0};
    double oldest_s = 0.0;
    hold(*device, 1000, {}, [&](int tick, Status status, const Sample& sample) {
      EXPECT_EQ(status, Status::ok);
      for (std::size_t axis = 0; axis < 3; ++axis) most[axis] = std::max(most[axis], sample.position[axis]);
      if (tick > 2) oldest_s = std::max(oldest_s, sample.channels[age_channel]);
    });
    // In the first second the slowest of the hand's sines, 10 mm at 0.31 Hz, was at its crest.
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(most[axis] - middle_of(*device, axis), 0.010, 0.0015);
    EXPECT_LE(oldest_s, 0.0011) << "a report a frame";
    EXPECT_NEAR(figure(*device, "report_rate"), 1000.0, 5.0);
    EXPECT_EQ(figure(*device, "malformed"), 0.0);
    EXPECT_EQ(figure(*device, "implausible"), 0.0);
    EXPECT_LE(figure(*device, "resent"), 0.0);
    EXPECT_LE(figure(*device, "counter_gaps"), 0.0);
  }
}

// Through driver, kernel and emulator, what WoodenHapticsSigns.* say of their tables.
TEST(WoodenHaptics, AForceMovesTheHandItsOwnWay) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const Emulator emulator(one.emulator + "&sway=0m");
    ASSERT_TRUE(becomes_attached(one.uri));
    const auto device = drivers::open_device(one.uri);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Axes stood{};
      hold(*device, 200, {}, [&](int, Status, const Sample& sample) { stood = sample.position; });
      Axes force{};
      force[axis] = 0.4;
      Axes moved{};
      hold(*device, 300, force, [&](int, Status, const Sample& sample) { moved = sample.position; });
      // 0.4 N less 0.1 N of friction at 300 N/m; friction also keeps it up to 0.3 mm from where it stood.
      EXPECT_NEAR(moved[axis] - stood[axis], 1.1e-3, 0.5e-3) << axis;
    }
  }
}

TEST(WoodenHaptics, TheTickAllocatesNothing) {
  const Emulator emulator("woody?generation=v2");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  const auto device = drivers::open_device("hid:1234:0006");
  for (int tick = 0; tick < 200; ++tick) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const NoAllocation guard;
    Sample sample;
    EXPECT_EQ(device->read(1e-3 * tick, sample), Status::ok);
    EXPECT_EQ(device->write({0.1, 0.2, 9.0}), Status::ok);
    device->release(0.0);
  }
}

TEST(WoodenHaptics, ALoopThatStopsWritingHasZeroCurrentWithinATenthOfASecond) {
  for (const char* generation : {"v1", "v2"}) {
    SCOPED_TRACE(generation);
    const TemporaryFolder folder;
    const std::string file = folder / "trace.csv";
    {
      const Emulator emulator(std::string("woody?sway=0m&generation=") + generation + "&trace=" + file);
      ASSERT_TRUE(becomes_attached("hid:1234:0006"));
      const auto device = drivers::open_device("hid:1234:0006");
      hold(*device, 200, {1.0, 0.0, 0.0});
      Sample last;
      loop(*device, 300, [&](int, Status status, const Sample& sample) {
        EXPECT_EQ(status, Status::ok) << "its position still comes";
        last = sample;
      });
      EXPECT_EQ(last.channels[1], 0.0);
    }
    const auto orders = read_orders(file);
    double last_nonzero_s = 0.0;
    double first_held_s = 0.0;
    double zero_s = 0.0;
    for (const auto& order : orders) {
      if (order.current_ma == std::array{0, 0, 0}) {
        if (last_nonzero_s > 0.0 && zero_s == 0.0) zero_s = order.time_s;
        continue;
      }
      if (first_held_s == 0.0) first_held_s = order.time_s;
      last_nonzero_s = order.time_s;
    }
    // The loop held its force for 0.2 s and then wrote no more.
    EXPECT_GT(last_nonzero_s, 0.0);
    EXPECT_GT(zero_s, first_held_s + 0.199);
    EXPECT_LE(zero_s, first_held_s + 0.2 + 0.1);
    EXPECT_EQ(count_watchdog_trips(file), 0) << "it has orders all the time";
  }
}

TEST(WoodenHaptics, ReleaseMakesTheForceZeroUntilTheNextWrite) {
  const Emulator emulator("woody?generation=v1");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  const auto device = drivers::open_device("hid:1234:0006");
  Sample sample;
  hold(*device, 20, {0.0, 1.0, 0.0});
  (void)device->read(0.1, sample);
  EXPECT_NE(sample.channels[0], 0.0);
  std::thread([&] { device->release(0.0); }).join();
  std::this_thread::sleep_for(std::chrono::milliseconds(3));
  (void)device->read(0.1, sample);
  EXPECT_EQ(sample.channels[0], 0.0);
  hold(*device, 5, {0.0, 1.0, 0.0}, [](int, Status, const Sample&) {});
  (void)device->read(0.2, sample);
  EXPECT_NE(sample.channels[0], 0.0);
  EXPECT_EQ(device->write({0.0, std::nan(""), 0.0}), Status::fault);
  std::this_thread::sleep_for(std::chrono::milliseconds(3));
  (void)device->read(0.3, sample);
  EXPECT_EQ(sample.channels[0], 0.0);
}

TEST(WoodenHaptics, AForceBeyondTheMotorsIsCutWithoutTurningIt) {
  const Emulator emulator("woody?generation=v2&model=woody-2016&sway=0m");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  const auto device = drivers::open_device("hid:1234:0006?model=woody-2016&most_current=1A");
  Sample sample;
  hold(*device, 1, {});
  ASSERT_EQ(device->write({0.0, 5.0, -5.0}), Status::ok);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  (void)device->read(0.0, sample);
  // 1 N y is 0.591 A in A, 1 N z is 0.788 A in C: five times both is too much, and C's is the largest.
  EXPECT_NEAR(sample.channels[2], -1.0, 0.0011);
  EXPECT_NEAR(sample.channels[0] / sample.channels[2], -0.591 / 0.788, 0.002);
  EXPECT_EQ(figure(*device, "current_limited"), 1.0);
}

TEST(WoodenHaptics, CountsFromWhereItIsToldToBeAtHome) {
  // 32760: the counters wrap while the hand sways.
  const Emulator emulator("woody?generation=v2&counter_offset=32760&button=0.2s&sway=0.005m");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  EXPECT_THAT(refusal("hid:1234:0006"), AllOf(HasSubstr("m from the middle of its workspace"),
                                              HasSubstr("hold it there and open it with calibrate=on")));
  const auto follow = [](Device& device) {
    hold(device, 900, {}, [&](int, Status status, const Sample& sample) {
      EXPECT_EQ(status, Status::ok);
      // It was opened somewhere within the sway of 5 mm and stays there.
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(std::abs(sample.position[axis] - middle_of(device, axis)), 0.011);
      }
    });
    EXPECT_EQ(figure(device, "implausible"), 0.0);
  };
  {
    const auto device = drivers::open_device("hid:1234:0006?calibrate=on");
    EXPECT_THAT(device->info().configuration, HasSubstr("home = \"where it was opened\""));
    follow(*device);
    Sample sample;
    (void)device->read(2.0, sample);
    EXPECT_EQ(sample.channels[button_channel], 1.0) << "pressed after 0.2 s, and latched";
  }
  const auto device = drivers::open_device("hid:1234:0006?preset=home");
  Sample sample;
  (void)device->read(0.0, sample);
  EXPECT_EQ(sample.channels[button_channel], 0.0) << "a preset forgets it";
  follow(*device);
}

TEST(WoodenHaptics, WhatItHadReadyWhenItWasClosedIsNotTakenForNew) {
  const Emulator emulator("woody?generation=v2&sway=0.02m");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  for (int times = 0; times < 4; ++times) {
    const auto device = drivers::open_device("hid:1234:0006");
    Sample first;
    ASSERT_EQ(device->read(0.0, first), Status::ok);
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
    Sample second;
    ASSERT_EQ(device->read(0.004, second), Status::ok);
    // No axis is faster than 0.075 m/s; in 0.7 s the tip goes on by many millimetres.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(second.position[axis], first.position[axis], 0.075 * 0.007 + 1e-4);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
  }
}

TEST(WoodenHaptics, TornTurnedLostAndRefusedReportsDoNoHarm) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const Emulator emulator(
        one.emulator, {"--fault", "drop@0.6:3,split@0.9,corrupt@1.2:2,stall@1.5:2,split@1.7:2,drop@1.9"});
    ASSERT_TRUE(becomes_attached(one.uri));
    const auto device = drivers::open_device(one.uri);
    int faults = 0;
    hold(*device, 2200, {}, [&](int, Status status, const Sample& sample) {
      faults += status != Status::ok;
      EXPECT_NE(status, Status::lost);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(std::abs(sample.position[axis] - middle_of(*device, axis)), 0.012);
      }
    });
    EXPECT_EQ(figure(*device, "implausible"), 2.0) << "those whose bits were turned";
    if (one.channels == 4) {
      EXPECT_EQ(faults, 0) << "another report comes a millisecond later";
      EXPECT_GE(figure(*device, "counter_gaps"), 4.0) << "what was lost is counted";
    } else {
      // Three lost in a row are 30 ms without a position: it is stale for the last ten of them.
      EXPECT_GE(faults, 8);
      EXPECT_LE(faults, 60);
      // One of the stalls met a transfer of reports, which needs no order.
      EXPECT_EQ(figure(*device, "resent"), 5.0)
          << "an order for each lost report, and for the one that stalled";
    }
    Sample last;
    EXPECT_EQ(device->read(2.2, last), Status::ok);
  }
}

TEST(WoodenHaptics, IsLostWhenItIsUnpluggedAndComesBackTwentyTimes) {
  Held at_first;
  for (int times = 0; times < 20; ++times) {
    Emulator emulator(times % 2 == 0 ? "woody?generation=v1" : "woody?generation=v2");
    ASSERT_TRUE(becomes_attached("hid:1234:0006"));
    {
      const auto device = drivers::open_device("hid:1234:0006");
      hold(*device, 20, {1.0, 0.0, 0.0});
      emulator.unplug();
      Sample sample;
      EXPECT_EQ(device->read(1.0, sample), Status::lost);
      EXPECT_EQ(device->write({}), Status::lost);
    }
    ASSERT_TRUE(becomes_attached("hid:", false));
    if (times == 0) at_first = held();
  }
  EXPECT_EQ(held(), at_first);
  EXPECT_THAT(refusal("hid:1234:0006"), HasSubstr("is not attached (0 of 1234:0006 found); plug it in"));
}

TEST(WoodenHaptics, OfTwoDevicesEachIsOpenedByItsIndexAndByOneProgram) {
  const Emulator first("woody?generation=v1");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  const Emulator second("woody?generation=v2");
  ASSERT_TRUE(becomes_attached("hid:1234:0006?index=1"));
  const auto one = drivers::open_device("hid:1234:0006");
  const auto other = drivers::open_device("hid:1234:0006?index=1");
  EXPECT_NE(one->info().model, other->info().model);
  EXPECT_THAT(refusal("hid:1234:0006?index=1"), HasSubstr("in use by another program"));
  EXPECT_THAT(refusal("hid:1234:0006?index=2"), HasSubstr("number 2 is not attached (2 of 1234:0006 found)"));
}

/// A process of its own that has a file open while the object lives.
class Holder {
 public:
  explicit Holder(const std::string& file) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error("pipe");
    process_ = fork();
    if (process_ == 0) {
      const char opened = open(file.c_str(), O_RDWR) >= 0 ? 'y' : 'n';
      (void)!write(ends[1], &opened, 1);
      pause();
      _exit(0);
    }
    char opened = 'n';
    (void)!read(ends[0], &opened, 1);
    holds_ = opened == 'y';
    close(ends[0]);
    close(ends[1]);
  }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;
  ~Holder() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  [[nodiscard]] bool holds() const { return holds_; }
  [[nodiscard]] pid_t process() const { return process_; }

 private:
  pid_t process_ = 0;
  bool holds_ = false;
};

std::string only_hidraw_node() {
  std::string found;
  for (const auto& entry : std::filesystem::directory_iterator("/dev")) {
    if (entry.path().filename().string().starts_with("hidraw")) found = entry.path();
  }
  return found;
}

// CHAI3D and its like take a device by its hidraw node and ask nobody.
TEST(WoodenHaptics, IsTakenFromNoProgramAndGivenToNone) {
  const Emulator emulator("woody?generation=v1");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  std::string node;
  for (int tries = 0; node.empty() && tries < 500; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    node = only_hidraw_node();
  }
  {
    const Holder other(node);
    ASSERT_TRUE(other.holds());
    EXPECT_THAT(refusal("hid:1234:0006"),
                HasSubstr(node + " is in use by another program (process " + std::to_string(other.process()) +
                          "); close that program"));
  }
  {
    const auto device = drivers::open_device("hid:1234:0006");
    EXPECT_EQ(only_hidraw_node(), "") << "the kernel has taken it away";
    EXPECT_FALSE(Holder(node).holds());
    EXPECT_THAT(refusal("hid:1234:0006"), HasSubstr("is in use by another program"));
    hold(*device, 50, {0.1, 0.0, 0.0});
  }
  EXPECT_NE(only_hidraw_node(), "") << "given back";
}

// What the udev rules give: the node of the device, and with it the right to take its interface from the
// kernel.
TEST(WoodenHaptics, AnOrdinaryUserHasItAloneToo) {
  const Emulator emulator("woody?generation=v2");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  const std::string node = drivers::list_attached().at(0).node;
  ASSERT_EQ(chmod(node.c_str(), 0666), 0);
  const AsNobody guard;
  {
    const auto device = drivers::open_device("hid:1234:0006");
    EXPECT_EQ(only_hidraw_node(), "");
    hold(*device, 50, {0.1, 0.0, 0.0});
  }
  EXPECT_NE(only_hidraw_node(), "");
}

TEST(WoodenHaptics, SaysWhatIsWrongAndHowToMendIt) {
  EXPECT_THAT(refusal("hid:1234:0007"),
              AllOf(HasSubstr("no HID device 'hid:1234:0007' is known"),
                    HasSubstr("hid:1234:0006 (WoodenHaptics)"), HasSubstr("hid:16c0:0486 (Polhem)")));
  EXPECT_THAT(refusal("hid:woody"), HasSubstr("expected hid:VENDOR:PRODUCT in hexadecimal"));
  EXPECT_THAT(
      refusal("hid:1234:0006?model=omega"),
      HasSubstr("option 'model' is 'omega', expected one of woody-2016, woody-2019, aluhaptics, polhem-v3"));
  EXPECT_THAT(refusal("hid:1234:0006?most_current=4A"),
              HasSubstr("expected a number with the unit A from 0 to 3"));
  EXPECT_THAT(refusal("hid:1234:0006?preset=here"), HasSubstr("expected home"));
  EXPECT_THAT(refusal("hid:1234:0006?colour=red"), HasSubstr("has no option 'colour'"));
  const Emulator emulator("woody?generation=v1");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  EXPECT_THAT(refusal("hid:1234:0006?preset=home"), HasSubstr("is a V1, whose counters cannot be preset"));
  EXPECT_THAT(refusal("hid:1234:0006?model=polhem-v3"),
              HasSubstr("there is no polhem-v3 with the reports of V1"));
  const AsNobody guard;
  EXPECT_THAT(refusal("hid:1234:0006"),
              AllOf(HasSubstr("no permission for /dev/bus/usb/"), HasSubstr("70-kerf.rules")));
  const auto attached = drivers::list_attached();
  ASSERT_EQ(attached.size(), 1U);
  EXPECT_THAT(attached[0].about, HasSubstr("WoodenHaptics"));
  EXPECT_TRUE(attached[0].emulated);
}

TEST(WoodenHapticsRate, IsAboutAThousandReportsASecondByTheClock) {
  for (const Generation& one : generations) {
    const Emulator emulator(one.emulator);
    ASSERT_TRUE(becomes_attached(one.uri));
    const auto device = drivers::open_device(one.uri);
    hold(*device, 1000, {0.1, 0.0, 0.0}, [](int, Status, const Sample&) {});
    const double rate = figure(*device, "report_rate");
    // A machine that is busy otherwise makes it less, but never as few as the hundred a second of a driver
    // that waits for its timeouts; and never more than one a frame.
    std::printf("%s: %.1f reports/s, %.0f resent\n", one.emulator.c_str(), rate, figure(*device, "resent"));
    EXPECT_GT(rate, 150.0) << one.emulator;
    EXPECT_LT(rate, 1010.0) << one.emulator;
  }
}

}  // namespace
}  // namespace kerf::test
