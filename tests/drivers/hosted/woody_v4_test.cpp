#include "kerf/drivers/protocols/woody_v4.h"

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
using testing::HasSubstr;

TEST(WoodyV4Text, HasItsSizeAndWhatTheFirmwareTakes) {
  using namespace std::string_literals;
  EXPECT_EQ(woody_v4::order({0, 0, 0}), "[0,0,0]\n\0\0\0\0\0\0\0\0"s);
  EXPECT_EQ(woody_v4::order({-5, 1648, 16159}), "[-5,1648,6000]\n\0"s);
  EXPECT_EQ(woody_v4::order({-1000, -2000, -3000}), "[-1000,-2000,-3000]\n"s);
}

TEST(WoodyV4Text, IsReadAsAWholeOrNotAtAll) {
  const auto answer = woody_v4::parse("[3,-1,2,300000,0,0,1023,8]");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->model, 3);
  EXPECT_THAT(answer->counter, testing::ElementsAre(-1, 2, 300000, 0, 0, 1023));
  EXPECT_EQ(answer->error, 8);
  for (const char* const text : {"", "[]", "[3,1,2,3,0,0,0]", "[3,1,2,3,0,0,0,0,0]", "[3,1,2,3,0,0,0,x]",
                                 "3,1,2,3,0,0,0,0", "[3, 1,2,3,0,0,0,0]", "[3,1,2,3,0,0,0,99999999999]"}) {
    EXPECT_FALSE(woody_v4::parse(text)) << text;
  }
  woody_v4::AnswerReader reader;
  reader.add("0,0]\n[3,1,2");
  EXPECT_EQ(reader.next(), "]");
  EXPECT_FALSE(reader.next());
  reader.add(",3,0,0,0,0]\n[3,4");
  EXPECT_EQ(reader.next(), "[3,1,2,3,0,0,0,0]");
  EXPECT_FALSE(reader.next());
  reader.add(std::string(200, 'x'));
  EXPECT_FALSE(reader.next());
}

class WoodyV4 : public testing::Test {
 protected:
  /// Until the sample is so, for ten seconds at most, with a force.
  template <typename Condition>
  static bool feels(Device& device, const Axes& force, const Condition& condition) {
    Sample sample;
    return becomes([&] {
      (void)device.write(force);
      return device.read(0.0, sample) == Status::ok && condition(sample);
    });
  }
  [[nodiscard]] std::string traced() const { return "&trace=" + (folder_ / "trace.csv").string(); }

  test::TemporaryFolder folder_;
};

// hfabapi's test program, with counters of zero and 100 N/m to the origin, sends [-5,1648,16159] (mA): a wall
// of a fifth of that sends a fifth. Where it then is, CHAI3D's driver says of the same arm: (0.025, 0, 0.205)
// m.
TEST_F(WoodyV4, IsWhereAndSendsWhatItsMakersProgramDoes) {
  const RunningSerialDevice running("woody-v4?sway=0mm&hand=off");
  const auto device = open_device(running.uri() + "?most_current=6A");
  EXPECT_EQ(device->info().model, "WoodenHaptics (V4)");
  ASSERT_EQ(device->info().axes.size(), 3U);
  EXPECT_NEAR(device->info().axes[2].resolution, 0.064e-3, 0.001e-3);
  Sample sample;
  ASSERT_EQ(device->read(0.0, sample), Status::ok);
  EXPECT_NEAR(sample.position[0], 0.025, 1e-4);
  EXPECT_NEAR(sample.position[1], 0.0, 1e-4);
  EXPECT_NEAR(sample.position[2], 0.205, 1e-4);
  EXPECT_TRUE(feels(*device, {-0.5, 0.0, -4.1}, [](const Sample& now) {
    return std::abs(now.channels[1] - 0.2 * 1.648) < 0.005 && std::abs(now.channels[2] - 0.2 * 16.159) < 0.02;
  }));
}

TEST_F(WoodyV4, AForceMovesTheTipItsOwnWay) {
  const RunningSerialDevice running("woody-v4?sway=0mm");
  const auto device = open_device(running.uri());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double force : {1.0, -1.0}) {
      Axes along{};
      along[axis] = force;
      // The hand has 300 N/m.
      EXPECT_TRUE(feels(*device, along,
                        [&](const Sample& now) {
                          const double middle = std::array{0.025, 0.0, 0.205}.at(axis);
                          return std::abs(now.position[axis] - middle - force / 300.0) < 0.6e-3;
                        }))
          << axis << force;
    }
  }
}

TEST_F(WoodyV4, GoesOnWhereAnswersAreLostTornOrComeTwice) {
  for (const char* const fault :
       {"drop@0.3:1,drop@0.6:4", "corrupt@0.4:5", "split@0.4:3", "duplicate@0.4:20"}) {
    const RunningSerialDevice running("woody-v4", fault);
    const auto device = open_device(running.uri());
    const auto seen = watch(*device, ticks(1500));
    ASSERT_EQ(seen.size(), 1500U) << fault;
    const auto good = std::ranges::count_if(seen, [](const Seen& one) { return one.status == Status::ok; });
    EXPECT_GT(good, 1200) << fault;
    EXPECT_EQ(seen.back().status, Status::ok) << fault;
  }
}

TEST_F(WoodyV4, NeverSendsAMessageBehindAnother) {
  // Each answer later than a tick: a host that pipelines has error 8 for most.
  const RunningSerialDevice running("woody-v4?answer=3ms");
  const auto device = open_device(running.uri());
  const auto seen = watch(*device, ticks(1000));
  for (const Seen& one : seen) ASSERT_EQ(one.sample.channels[3], 0.0);
  EXPECT_GT(std::ranges::count_if(seen, [](const Seen& one) { return one.status == Status::ok; }), 800);
}

TEST_F(WoodyV4, IsLetGoWhenItsProgramIsKilled) {
  const RunningSerialDevice running("woody-v4?sway=0mm" + traced());
  kill_who_holds(running.uri(), {1.0, 0.0, 0.0});
  EXPECT_TRUE(becomes([&] { return is_let_go(forces_of(folder_ / "trace.csv"), 0.9); }));
}

TEST_F(WoodyV4, KnowsItsPlaceByTheButtonOrByCalibration) {
  {
    const RunningSerialDevice running("woody-v4?sway=0mm&counter_offset=5000");
    EXPECT_THAT(refusal_to_open(running.uri()), HasSubstr("calibrate=on"));
    const auto device = open_device(running.uri() + "?calibrate=on");
    Sample sample;
    ASSERT_EQ(device->read(0.0, sample), Status::ok);
    EXPECT_NEAR(sample.position[2], 0.205, 1e-4);
  }
  const RunningSerialDevice running("woody-v4?sway=0mm&counter_offset=500&button=0.7s");
  const auto device = open_device(running.uri());
  EXPECT_TRUE(feels(*device, {}, [](const Sample& now) { return std::abs(now.position[2] - 0.205) < 1e-4; }));
}

TEST_F(WoodyV4, ThatIsUnpluggedIsLost) {
  const RunningSerialDevice running("woody-v4", "unplug@0.8");
  const auto device = open_device(running.uri());
  const auto seen = watch(*device, ticks(6000));
  EXPECT_LT(seen.size(), 6000U);
  EXPECT_TRUE(becomes([&] { return !device->trouble().empty(); }));
}

TEST_F(WoodyV4, IsRefusedWithWhatIsWrong) {
  EXPECT_THAT(refusal_to_open("woody-v4:"), HasSubstr("at which port"));
  EXPECT_THAT(refusal_to_open("woody-v4:/dev/ttyNone"), HasSubstr("there is no port"));
  const RunningSerialDevice polhem("woody-v4?model=1");
  EXPECT_THAT(refusal_to_open(polhem.uri()), HasSubstr("model 1"));
  EXPECT_THAT(refusal_to_open(polhem.uri() + "?most_current=7A"), HasSubstr("from 0 to 6"));
  EXPECT_THAT(refusal_to_open(polhem.uri() + "?model=woody"), HasSubstr("no option 'model'"));
  const RunningSerialDevice slider("slider");
  EXPECT_THAT(refusal_to_open("woody-v4:" + slider.path()), HasSubstr("(V4)"));
  const RunningSerialDevice silent("woody-v4?answer=1s");
  EXPECT_THAT(refusal_to_open(silent.uri()), HasSubstr("too late"));
  const RunningSerialDevice woody("woody-v4");
  const auto first = open_device(woody.uri());
  EXPECT_THAT(refusal_to_open(woody.uri()), HasSubstr("another program has"));
}

}  // namespace
}  // namespace kerf::drivers
