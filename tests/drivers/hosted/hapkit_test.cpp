#include "kerf/drivers/protocols/hapkit.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "../force/watched_sensor.h"
#include "plugin_of.h"
#include "support/program.h"
#include "support/running_box.h"

namespace kerf::drivers {
namespace {

using test::RunningSerialDevice;
using testing::AllOf;
using testing::HasSubstr;

/// Of the emulator: no boot loader, a hand that keeps still.
constexpr const char* still = "hapkit?boot=0s&sway=0mm";

class Hapkit : public testing::Test {
 protected:
  /// Until the sample is so, for ten seconds at most, with a force.
  template <typename Condition>
  static bool feels(Device& device, double force_n, const Condition& condition) {
    Sample sample;
    return becomes([&] {
      (void)device.write({force_n});
      return device.read(0.0, sample) == Status::ok && condition(sample);
    });
  }
  [[nodiscard]] std::string trace() const { return (folder_ / "trace.csv").string(); }
  [[nodiscard]] std::string traced() const { return "&trace=" + trace(); }

  test::TemporaryFolder folder_;
};

// The hand has 300 N/m, and goes twice as far at most. Where the sensor is in its half turn when it is opened
// makes no difference: one that is miscounted is 21 mm.
TEST_F(Hapkit, AForceMovesTheHandleItsOwnWay) {
  for (const char* const begins : {"100", "850"}) {
    const RunningSerialDevice running(still + std::string("&begins=") + begins);
    const auto device = open_device(running.uri());
    ASSERT_EQ(device->info().axes.size(), 1U);
    EXPECT_EQ(device->info().axes[0].position_unit, "m");
    EXPECT_NEAR(device->info().axes[0].force_limit, 0.9 * 4.9333, 1e-3);
    EXPECT_THAT(device->info().configuration, HasSubstr("published sketches, not measured on this device"));
    for (const double way : {1.0, -1.0}) {
      double farthest_m = 0.0;
      EXPECT_TRUE(feels(*device, 2.4 * way,
                        [&](const Sample& now) {
                          farthest_m = std::max(farthest_m, std::abs(now.position[0]));
                          return way * now.position[0] > 2e-3;
                        }))
          << begins << " " << way;
      EXPECT_LT(farthest_m, 17e-3);
      // Friction of 0.1 N holds it up to 0.33 mm off.
      EXPECT_TRUE(feels(*device, 0.0, [](const Sample& now) { return std::abs(now.position[0]) < 5e-4; }));
    }
  }
}

TEST_F(Hapkit, ForcesComeBackAsTheyWereSent) {
  const RunningSerialDevice running(still + traced());
  const auto device = open_device(running.uri());
  const hapkit::Made made;
  for (const double force_n : {0.5, -2.0, 4.4, 100.0}) {
    const double duty = made.duty(std::min(force_n, 0.9 * made.full_force_n())) / 255.0;
    EXPECT_TRUE(feels(*device, force_n, [&](const Sample& now) {
      return now.channels[2] == duty && now.channels[3] == 0.0;
    })) << force_n;
    const auto forces = forces_of(trace());
    // A step of the duty is at most two of 255.
    EXPECT_TRUE(becomes([&] {
      return std::ranges::any_of(forces_of(trace()), [&](double one) {
        return std::abs(one - std::min(std::abs(force_n), 4.44)) < 4.9333 * 2.0 / 255.0;
      });
    })) << force_n;
  }
}

TEST_F(Hapkit, WhoseMotorIsWiredTheOtherWayIsToldSo) {
  const RunningSerialDevice running(still + std::string("&motor=-1"));
  {
    const auto device = open_device(running.uri());
    EXPECT_TRUE(feels(*device, 2.0, [](const Sample& now) { return now.position[0] < -5e-3; }));
    EXPECT_TRUE(feels(*device, 0.0, [](const Sample& now) { return std::abs(now.position[0]) < 5e-4; }));
  }
  const auto device = open_device(running.uri() + "?motor=-1");
  EXPECT_TRUE(feels(*device, 2.0, [](const Sample& now) { return now.position[0] > 5e-3; }));
}

TEST_F(Hapkit, LosesWhatTheLineLosesAndCountsIt) {
  struct Case {
    const char* fault;
    double missing;
    double repeated;
  };
  for (const Case& one : {Case{"drop@0.25:25", 25, 0}, Case{"corrupt@0.25:5", 5, 0},
                          Case{"split@0.25:3", 3, 0}, Case{"duplicate@0.25:20", 0, 20}}) {
    const RunningSerialDevice running(still + std::string("&noise=0"), one.fault);
    const auto device = open_device(running.uri());
    const auto seen = watch(*device, ticks(500));
    ASSERT_EQ(seen.size(), 500U) << one.fault;
    EXPECT_TRUE(feels(*device, 0.0, [](const Sample&) { return true; })) << one.fault;
    EXPECT_EQ(figure(*device, "reports_missing"), one.missing) << one.fault;
    EXPECT_EQ(figure(*device, "reports_repeated"), one.repeated) << one.fault;
    for (const Seen& now : seen) ASSERT_LT(std::abs(now.sample.position[0]), 1e-4) << one.fault;
  }
}

// The board is first: the process of the device waits for 50 ms. On a busy machine not at once.
TEST_F(Hapkit, IsLetGoByItsBoardWhereNoForceComes) {
  const RunningSerialDevice running(still + traced());
  const auto device = open_device(running.uri());
  EXPECT_TRUE(becomes([&] {
    EXPECT_TRUE(feels(*device, 1.0, [](const Sample& now) { return now.channels[2] > 0.4; }));
    Sample sample;
    return becomes([&] { return device->read(0.0, sample) == Status::ok && sample.channels[2] == 0.0; }) &&
           sample.channels[3] == hapkit::let_go &&
           test::read_text(trace()).find(",watchdog,0,") != std::string::npos;
  }));
  EXPECT_TRUE(feels(*device, 1.0, [](const Sample& now) { return now.channels[2] > 0.4; }));
}

TEST_F(Hapkit, IsLetGoWhenItsProgramIsKilled) {
  const RunningSerialDevice running(still + traced());
  kill_who_holds(running.uri(), {1.0});
  EXPECT_TRUE(becomes([&] { return is_let_go(forces_of(trace()), 0.9); }));
}

TEST_F(Hapkit, ThatIsUnpluggedSilentOrBeginsAnewIsLostAndSaysSo) {
  struct Case {
    const char* fault;
    const char* trouble;
  };
  for (const Case& one : {Case{"unplug@0.5", "port is gone"}, Case{"silence@0.5:1000s", ""},
                          Case{"restart@0.5:0.2s", "began anew and has lost its place"}}) {
    const RunningSerialDevice running(still, one.fault);
    const auto device = open_device(running.uri());
    const auto seen = watch(*device, ticks(6000));
    EXPECT_LT(seen.size(), 6000U) << one.fault;
    EXPECT_TRUE(becomes([&] { return device->trouble().find(one.trouble) != std::string::npos; }))
        << device->trouble();
  }
}

// Opening its port resets a board, perhaps after some frames of what it said before.
TEST_F(Hapkit, WaitsForTheBootLoaderOfItsBoard) {
  for (const char* const fault : {"", "restart@0.02:0.3s"}) {
    const RunningSerialDevice running("hapkit?boot=0.3s&sway=0mm", fault);
    const RunningSerialDevice at_once(still, fault);
    for (const auto* const board : {&running, &at_once}) {
      const auto device = open_device(board->uri());
      EXPECT_TRUE(feels(*device, 1.0, [](const Sample& now) { return now.channels[2] > 0.4; })) << fault;
    }
  }
}

TEST_F(Hapkit, IsRefusedWithWhatIsWrong) {
  EXPECT_THAT(refusal_to_open("hapkit:"), HasSubstr("at which port"));
  EXPECT_THAT(refusal_to_open("hapkit:/dev/ttyNone"), HasSubstr("there is no port"));
  EXPECT_THAT(refusal_to_open("hapkit:/dev/null?firmware=course"), HasSubstr("expected kerf or stream"));
  const RunningSerialDevice board(still);
  EXPECT_THAT(refusal_to_open(board.uri() + "?motor=2"), HasSubstr("expected 1, or -1"));
  EXPECT_THAT(refusal_to_open(board.uri() + "?flip=1.5"), HasSubstr("from 700 to 1024"));
  EXPECT_THAT(refusal_to_open(board.uri() + "?radius=1mm"), HasSubstr("no option 'radius'"));
  EXPECT_THAT(refusal_to_open(board.uri() + "?firmware=stream&motor=-1"), HasSubstr("no option 'motor'"));
  EXPECT_THAT(refusal_to_open(board.uri() + "?firmware=stream"), HasSubstr("what comes is no text"));
  const auto first = open_device(board.uri());
  EXPECT_THAT(refusal_to_open(board.uri()), HasSubstr("another program has"));
  const RunningSerialDevice slider("slider");
  EXPECT_THAT(refusal_to_open("hapkit:" + slider.path()), HasSubstr("no frame of Kerf's sketch"));
  const RunningSerialDevice prints("hapkit?firmware=stream&boot=0s");
  EXPECT_THAT(refusal_to_open(prints.uri()), AllOf(HasSubstr("no frame"), HasSubstr("firmware=stream")));
}

TEST_F(Hapkit, ThatPrintsIsReadAndTakesNoForce) {
  const RunningSerialDevice running("hapkit?firmware=stream&boot=0.2s&sway=30mm&button=0.7s",
                                    "corrupt@0.5:2");
  const auto device = open_device(running.uri() + "?firmware=stream");
  EXPECT_EQ(device->info().axes.at(0).force_limit, 0.0);
  ASSERT_TRUE(device->info().button_channel);
  const auto seen = watch(*device, ticks(1000));
  ASSERT_EQ(seen.size(), 1000U);
  EXPECT_EQ(seen.front().sample.channels[1], 0.0);
  EXPECT_EQ(seen.back().sample.channels[1], 1.0);
  const auto place = [](const Seen& one) { return one.sample.position[0]; };
  EXPECT_GT(std::ranges::max(seen, {}, place).sample.position[0], 5e-3);
  // As fast as a hand that sways by 30 mm at 0.31 Hz: 58 mm/s.
  const auto fastest = std::ranges::max(seen, {}, [](const Seen& one) { return one.sample.velocity[0]; });
  EXPECT_GT(fastest.sample.velocity[0], 0.02);
  EXPECT_LT(fastest.sample.velocity[0], 0.08);
  EXPECT_EQ(device->write({1.0}), Status::ok);
}

}  // namespace
}  // namespace kerf::drivers
