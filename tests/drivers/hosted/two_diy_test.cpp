#include "kerf/drivers/protocols/two_diy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include <fcntl.h>
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
using testing::ElementsAre;
using testing::HasSubstr;

// 12 deg is 0x41400000, 4880 counts 0x45988000, 168 deg 0x43280000; port 1 first.
TEST(TwoDiyBytes, AreThoseOfTheFirmware) {
  const auto& version = *two_diy::find("v3.1");
  EXPECT_THAT(two_diy::reset(), ElementsAre(0, 5));
  EXPECT_THAT(two_diy::set_up(version),
              ElementsAre(1, 5, 3, 1, 1, 3, 1, 1, 0, 0, 0x00, 0x00, 0x40, 0x41, 0x00, 0x80, 0x98, 0x45, 0x00,
                          0x00, 0x28, 0x43, 0x00, 0x80, 0x98, 0x45));
  // Joint 1 is at port 2; 0.1 N·m is 0x3DCCCCCD, 0.123 0x3DFBE76D.
  EXPECT_THAT(two_diy::torques(version, {0.1, -9.0}),
              ElementsAre(2, 5, 0x6D, 0xE7, 0xFB, 0xBD, 0xCD, 0xCC, 0xCC, 0x3D));
  EXPECT_THAT(two_diy::torques(version, {std::nan(""), 0.0}), ElementsAre(2, 5, 0, 0, 0, 0, 0, 0, 0, 0));
  const std::array<std::uint8_t, 9> answer{5, 0x00, 0x00, 0x40, 0x41, 0x00, 0x00, 0x28, 0x43};
  const auto angles = two_diy::parse(version, answer);
  ASSERT_TRUE(angles);
  EXPECT_THAT(*angles, ElementsAre(168.0, 12.0));
  const std::array<std::uint8_t, 9> other{4, 0x00, 0x00, 0x40, 0x41, 0x00, 0x00, 0x28, 0x43};
  EXPECT_FALSE(two_diy::parse(version, other));
  const std::array<std::uint8_t, 9> no_number{5, 0x00, 0x00, 0xC0, 0x7F, 0x00, 0x00, 0x28, 0x43};
  EXPECT_FALSE(two_diy::parse(version, no_number));
  EXPECT_FALSE(two_diy::parse(version, std::span(answer).first(8)));
}

// A board that has lost a byte takes what follows for something else. Of orders of no torque, whatever it
// then takes for a torque is next to none.
TEST(TwoDiyBytes, OfNoTorqueAreHarmlessHoweverTheyAreShifted) {
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < 3; ++i)
    std::ranges::copy(two_diy::torques(*two_diy::find("v3.1"), {}), std::back_inserter(stream));
  for (std::size_t at = 0; at + 4 <= stream.size(); ++at) {
    float torque = 0.0F;
    std::memcpy(&torque, &stream[at], sizeof torque);
    EXPECT_LT(std::abs(torque), 1e-30F) << at;
  }
}

/// Until the sample is so, for ten seconds at most, with a force.
template <typename Condition>
bool feels(Device& device, const Axes& force, const Condition& condition) {
  Sample sample;
  return becomes([&] {
    (void)device.write(force);
    return device.read(0.0, sample) == Status::ok && condition(sample);
  });
}

// The firmware takes byte by byte, however many have come at once.
TEST(TwoDiyBoard, TakesWhatStandsBehindItsReset) {
  const RunningSerialDevice running("2diy?sway=0mm");
  const auto& version = *two_diy::find("v3.1");
  std::vector<std::uint8_t> orders;
  for (const auto& order : {two_diy::reset(), two_diy::set_up(version), two_diy::torques(version, {})})
    std::ranges::copy(order, std::back_inserter(orders));
  const int port = open(running.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_EQ(write(port, orders.data(), orders.size()), static_cast<ssize_t>(orders.size()));
  std::array<std::uint8_t, 64> answer{};
  ssize_t size = 0;
  EXPECT_TRUE(becomes([&] { return (size = read(port, answer.data(), answer.size())) > 0; }));
  close(port);
  EXPECT_EQ(size, 9);
}

TEST(TwoDiy, AForceMovesTheHandleItsOwnWay) {
  for (const char* const version : {"v3.1", "original"}) {
    const RunningSerialDevice running(std::string("2diy?sway=0mm&version=") + version);
    const auto device = open_device(running.uri() + "?version=" + version);
    ASSERT_EQ(device->info().axes.size(), 2U);
    const auto& made = two_diy::find(version)->made;
    Sample sample;
    ASSERT_EQ(device->read(0.0, sample), Status::ok);
    const double rest_m = sample.position[1];
    EXPECT_NEAR(sample.position[0], 0.5 * made.between_m, 2e-3);
    // A hand has lifted it by 50 mm, and has 300 N/m.
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (const double force : {0.6, -0.6}) {
        Axes along{};
        along[axis] = force;
        const double middle = axis == 0 ? 0.5 * made.between_m : rest_m + 0.05;
        EXPECT_TRUE(feels(*device, along,
                          [&](const Sample& now) {
                            return std::abs(now.position[axis] - middle - force / 300.0) < 0.7e-3 &&
                                   std::abs(now.position[1] - rest_m - 0.05) < 4e-3;
                          }))
            << version << axis << force;
      }
    }
  }
}

TEST(TwoDiy, GoesOnWhereAnswersAreLostOrTurned) {
  for (const char* const fault : {"drop@0.4:3", "corrupt@0.4:5", "split@0.4:3", "duplicate@0.4:20"}) {
    const RunningSerialDevice running("2diy", fault);
    const auto device = open_device(running.uri());
    const auto seen = watch(*device, ticks(1500));
    ASSERT_EQ(seen.size(), 1500U) << fault;
    EXPECT_GT(std::ranges::count_if(seen, [](const Seen& one) { return one.status == Status::ok; }), 1200)
        << fault;
    EXPECT_EQ(seen.back().status, Status::ok) << fault;
  }
}

// Its board has no watchdog: whoever lets go is the host.
TEST(TwoDiy, IsLetGoWhenItsProgramIsKilled) {
  const test::TemporaryFolder folder;
  const std::string trace = (folder / "trace.csv").string();
  const RunningSerialDevice running("2diy?sway=0mm&trace=" + trace);
  kill_who_holds(running.uri(), {0.0, 0.5, 0.0});
  EXPECT_TRUE(becomes([&] { return is_let_go(forces_of(trace), 0.4); }));
}

TEST(TwoDiy, ThatIsUnpluggedOrSilentIsLostAndSaysSo) {
  for (const char* const fault : {"unplug@0.8", "silence@0.8:1000s"}) {
    const RunningSerialDevice running("2diy", fault);
    const auto device = open_device(running.uri());
    const auto seen = watch(*device, ticks(6000));
    EXPECT_LT(seen.size(), 6000U) << fault;
    EXPECT_TRUE(becomes([&] { return !device->trouble().empty(); })) << fault;
  }
}

TEST(TwoDiy, IsRefusedWithWhatIsWrong) {
  EXPECT_THAT(refusal_to_open("2diy:"), HasSubstr("at which port"));
  EXPECT_THAT(refusal_to_open("2diy:/dev/ttyNone"), HasSubstr("there is no port"));
  const RunningSerialDevice board("2diy");
  EXPECT_THAT(refusal_to_open(board.uri() + "?version=v9"), HasSubstr("expected original, v2, v3 or v3.1"));
  const auto first = open_device(board.uri());
  EXPECT_THAT(refusal_to_open(board.uri()), HasSubstr("another program has"));
  const RunningSerialDevice woody("woody-v4");
  EXPECT_THAT(refusal_to_open("2diy:" + woody.path()), HasSubstr("does not answer as the board of a 2DIY"));
}

}  // namespace
}  // namespace kerf::drivers
