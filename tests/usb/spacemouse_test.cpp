#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "emulator.h"
#include "opening.h"

namespace kerf::test {
namespace {

using drivers::Status;

TEST(SpaceMouse, FollowsTheCapAtItsOwnPace) {
  const Emulator emulator("spacemouse?amplitude=350");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const auto device = drivers::open_device("spacemouse:0?reach=0.1m");
  EXPECT_EQ(device->info().model, "SpaceNavigator");
  EXPECT_EQ(device->info().axes.size(), 6U);
  double farthest = 0.0;
  double oldest = 0.0;
  bool pressed = false;
  loop(*device, 4000, [&](int tick, Status status, const drivers::Sample& sample) {
    EXPECT_EQ(status, Status::ok);
    farthest = std::max(farthest, std::abs(sample.position[0]));
    if (tick > 100) oldest = std::max(oldest, sample.channels[0]);
    pressed |= sample.channels[1] == 1.0;
  });
  // Within 4 s of its 7.7 s period the cap has been at its full deflection, 350, which is 0.1 m.
  EXPECT_NEAR(farthest, 0.1, 0.1 / 350.0);
  EXPECT_TRUE(pressed);
  // One report each 8 ms: translation and rotation by turns.
  EXPECT_NEAR(figure(*device, "report_rate"), 125.0, 10.0);
  EXPECT_LT(oldest, 0.03);
}

// The emulated cap begins in the positive direction of each of its own axes: to the right, towards the user
// and down, and about each of these.
TEST(SpaceMouse, TurnsThemIntoTheFrameOfTheHouseAndItsUnits) {
  const Emulator emulator("spacemouse?amplitude=350");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const auto device = drivers::open_device("spacemouse:0?reach=0.1m&swing=30deg");
  std::array<double, 6> first{};
  std::array<double, 6> farthest{};
  loop(*device, 4000, [&](int, Status, const drivers::Sample& sample) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      if (first[axis] == 0.0) first[axis] = sample.position[axis];
      farthest[axis] = std::max(farthest[axis], std::abs(sample.position[axis]));
    }
  });
  const std::array<double, 6> sign{1.0, -1.0, -1.0, 1.0, -1.0, -1.0};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const double travel = axis < 3 ? 0.1 : std::numbers::pi / 6.0;
    EXPECT_GT(first[axis] * sign[axis], 0.0) << axis;
    EXPECT_NEAR(farthest[axis], travel, 0.01 * travel) << axis;
    EXPECT_NEAR(device->info().axes[axis].upper, travel, 1e-12) << axis;
    EXPECT_NEAR(device->info().axes[axis].resolution, travel / 350.0, 1e-12) << axis;
  }
}

TEST(SpaceMouse, OfAReceiverTheCapIsReadAndNotItsOtherInterface) {
  const Emulator emulator("spacemouse?receiver=on");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const auto attached = drivers::list_attached();
  EXPECT_EQ(attached.size(), 1U);
  const auto device = drivers::open_device("spacemouse:0");
  double farthest = 0.0;
  loop(*device, 1000, [&](int, Status status, const drivers::Sample& sample) {
    EXPECT_EQ(status, Status::ok);
    EXPECT_EQ(sample.age_s, sample.channels[0]);
    farthest = std::max(farthest, std::abs(sample.position[0]));
  });
  EXPECT_GT(farthest, 0.02);
}

TEST(SpaceMouse, IsLostWhenItIsUnpluggedAndComesBack) {
  Emulator emulator("spacemouse");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  {
    const auto device = drivers::open_device("spacemouse:0");
    Status last = Status::ok;
    loop(*device, 1000, [&](int tick, Status status, const drivers::Sample&) {
      if (tick == 200) emulator.unplug();
      last = status;
    });
    EXPECT_EQ(last, Status::lost);
  }
  ASSERT_TRUE(becomes_attached("spacemouse:", false));
  EXPECT_THROW((void)drivers::open_device("spacemouse:0"), drivers::DeviceError);
  const Emulator again("spacemouse");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  loop(*drivers::open_device("spacemouse:0"), 50,
       [&](int, Status status, const drivers::Sample&) { EXPECT_EQ(status, Status::ok); });
}

TEST(SpaceMouse, TakesNoHarmFromTornAndTurnedReports) {
  const Emulator emulator("spacemouse", {"--fault", "split@0.5:20,corrupt@1.0:20,drop@1.5:20"});
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const auto device = drivers::open_device("spacemouse:0");
  loop(*device, 2500, [&](int, Status status, const drivers::Sample& sample) {
    EXPECT_EQ(status, Status::ok);
    for (const double position : sample.position) EXPECT_LE(std::abs(position), 0.51);
  });
  // Too short ones and unknown ones the kernel keeps to itself: 60 of some 310 are missing, the rest came.
  EXPECT_NEAR(figure(*device, "reports"), 250.0, 15.0);
  drivers::Sample last;
  EXPECT_EQ(device->read(2.5, last), Status::ok);
  EXPECT_LT(last.channels[0], 0.03);
}

TEST(SpaceMouse, OfTwoProgramsOnlyOneHasIt) {
  const Emulator emulator("spacemouse");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const auto device = drivers::open_device("spacemouse:0");
  EXPECT_THAT(refusal("spacemouse:0"), testing::HasSubstr("in use by another program"));
}

TEST(SpaceMouse, SaysHowToObtainThePermission) {
  const Emulator emulator("spacemouse");
  ASSERT_TRUE(becomes_attached("spacemouse:0"));
  const AsNobody guard;
  EXPECT_THAT(refusal("spacemouse:0"), testing::AllOf(testing::HasSubstr("no permission for /dev/hidraw"),
                                                      testing::HasSubstr("70-kerf.rules")));
}

}  // namespace
}  // namespace kerf::test
