#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kerf/drivers/streaming_force_sensors.h"
#include "support/program.h"
#include "support/running_box.h"
#include "watched_sensor.h"

namespace kerf::drivers {
namespace {

using test::RunningSerialSensor;
using testing::AllOf;
using testing::HasSubstr;

struct Sensor {
  const char* device;
  const char* options;
  double force_step;
  double torque_step;
  std::size_t components;
};

class EachSerialSensor : public testing::TestWithParam<Sensor> {};

TEST_P(EachSerialSensor, TellsWhatActed) {
  const Sensor& sensor = GetParam();
  const test::TemporaryFolder folder;
  std::vector<Seen> seen;
  {
    const std::string device = sensor.device;
    const RunningSerialSensor running(device + (device.find('?') == std::string::npos ? "?" : "&") +
                                      "trace=" + (folder / "trace.csv").string());
    const auto opened = open_device(running.uri() + sensor.options);
    EXPECT_EQ(opened->info().axes.size(), 6U);
    seen = watch(*opened, ticks(400));
    EXPECT_EQ(figure(*opened, "frames_lost"), 0.0);
    EXPECT_EQ(figure(*opened, "wrong_frames"), 0.0);
  }
  const auto truth = measured_in(folder / "trace.csv");
  std::size_t compared = 0;
  for (const Seen& one : seen) {
    if (one.status != Status::ok) continue;
    ASSERT_TRUE(
        is_among(truth, one.sample.force_measured, sensor.force_step, sensor.torque_step, sensor.components))
        << one.scan();
    ++compared;
  }
  EXPECT_GT(compared, 100U);
  expect_growing(seen);
}

INSTANTIATE_TEST_SUITE_P(
    Of, EachSerialSensor,
    testing::Values(Sensor{"bota", "", 1e-6, 1e-7, 6}, Sensor{"bota?boot=off", "?rate=800Hz", 1e-6, 1e-7, 6},
                    Sensor{"optoforce", "?counts=100,100,100,2000,2000,2000", 0.0051, 0.00026, 6},
                    Sensor{"optoforce?components=3", "?counts=100,100,100&rate=333Hz", 0.0051, 0.0, 3},
                    Sensor{"ft300", "", 0.0051, 0.00051, 6},
                    Sensor{"ft300?streaming=on", "", 0.0051, 0.00051, 6}));

TEST(SerialForce, ABotaIsNumberedByItsStamps) {
  const RunningSerialSensor running("bota?loss=0.1&seed=3");
  const auto device = open_device(running.uri());
  const auto seen = watch(*device, ticks(500));
  const double frames = figure(*device, "frames");
  const double lost = figure(*device, "frames_lost");
  EXPECT_NEAR(lost / (lost + frames), 0.1, 0.05);
  // 19.53125 us times 51.
  EXPECT_NEAR(figure(*device, "frame_rate"), 1003.9, 40.0);
  expect_growing(seen);
}

TEST(SerialForce, AnOptoforceIsNumberedByItsCounter) {
  const RunningSerialSensor running("optoforce", "drop@0.6:25");
  const auto device = open_device(running.uri() + "?counts=100,100,100,2000,2000,2000");
  watch(*device, [&](const auto&) { return figure(*device, "frames_lost") >= 25.0; });
  EXPECT_EQ(figure(*device, "frames_lost"), 25.0);
}

TEST(SerialForce, ATurnedByteIsNoForce) {
  for (const char* device : {"bota", "optoforce", "ft300"}) {
    const RunningSerialSensor running(device, "corrupt@0.7:5");
    const bool needs_counts = std::string(device) == "optoforce";
    const auto opened =
        open_device(running.uri() + (needs_counts ? "?counts=100,100,100,2000,2000,2000" : ""));
    const auto seen = watch(
        *opened, [&](const auto& all) { return figure(*opened, "frames_lost") >= 5.0 && all.size() > 700; });
    EXPECT_EQ(figure(*opened, "frames_lost"), 5.0) << device;
    EXPECT_GE(figure(*opened, "wrong_frames"), 1.0) << device;
    for (const Seen& one : seen) {
      if (one.status == Status::ok) {
        ASSERT_LT(std::abs(one.sample.force_measured[0]), 8.01) << device;
      }
    }
  }
}

TEST(SerialForce, AnOverloadIsNoForce) {
  for (const char* device : {"bota", "optoforce"}) {
    const RunningSerialSensor running(device, "overload@0.6:0.2s");
    const bool needs_counts = std::string(device) == "optoforce";
    const auto opened =
        open_device(running.uri() + (needs_counts ? "?counts=100,100,100,2000,2000,2000" : ""));
    watch(*opened, [&](const auto&) { return figure(*opened, "overloads") >= 20.0; });
    EXPECT_GE(figure(*opened, "overloads"), 20.0) << device;
  }
}

TEST(SerialForce, APortThatIsPulledOutIsLost) {
  for (const char* device : {"bota", "ft300"}) {
    const RunningSerialSensor running(device, "unplug@0.8");
    const auto opened = open_device(running.uri());
    const auto seen = watch(*opened, ticks(6000));
    EXPECT_LT(seen.size(), 6000U);
    Sample sample;
    EXPECT_EQ(opened->read(10.0, sample), Status::lost) << device;
  }
}

// An FT300 that sends 98.5 Hz where its data sheet says 100.
TEST(SerialForce, ASensorThatIsSlowerThanItSaysKeepsItsTimes) {
  const RunningSerialSensor running("ft300?drift=15000ppm");
  const auto device = open_device(running.uri());
  const auto seen = watch(*device, ticks(4000));
  // Between frames an age is a period at most, and the rest is what held the frame up.
  const auto old =
      std::ranges::count_if(seen, [](const Seen& one) { return !(one.sample.channels[0] < 0.018); });
  EXPECT_LT(old, static_cast<std::ptrdiff_t>(seen.size() / 10));
  EXPECT_EQ(figure(*device, "frames_lost"), 0.0);
  EXPECT_NEAR(figure(*device, "frame_rate"), 100.0 / 1.015, 0.5);
}

TEST(SerialForce, GoesOnAfterAMomentWithoutPower) {
  const RunningSerialSensor running("bota", "restart@0.8:0.3s");
  const auto device = open_device(running.uri());
  const auto seen = watch(*device, [&](const auto& all) {
    return figure(*device, "restarts") > 0.0 && all.back().status == Status::ok && all.size() > 400;
  });
  EXPECT_EQ(figure(*device, "restarts"), 1.0);
  expect_growing(seen);
}

TEST(SerialForce, IsRefusedWithWhatIsWrongAndWhatMendsIt) {
  EXPECT_THAT(refusal_to_open("bota:"), HasSubstr("at which port"));
  EXPECT_THAT(refusal_to_open("bota:/dev/ttyNone"),
              AllOf(HasSubstr("there is no port"), HasSubstr("/dev/serial/by-id")));
  EXPECT_THAT(refusal_to_open("ft300:/dev/null"), HasSubstr("is no serial port"));
  EXPECT_THAT(refusal_to_open("bota:/dev/null?baud=1200"), HasSubstr("460800"));
  EXPECT_THAT(refusal_to_open("bota:/dev/null?rate=20Hz"), HasSubstr("100 to 1003"));
  EXPECT_THAT(refusal_to_open("optoforce:/dev/null"), HasSubstr("data sheet"));
  EXPECT_THAT(refusal_to_open("optoforce:/dev/null?counts=1,1,1&rate=200Hz"), HasSubstr("1000, 333"));
  const RunningSerialSensor ft300("ft300");
  EXPECT_THAT(refusal_to_open("bota:" + ft300.path()), HasSubstr("nothing comes from"));
  EXPECT_THAT(refusal_to_open("bota:" + ft300.path() + "?rate=800Hz"), HasSubstr("does not acknowledge 'C'"));
  const RunningSerialSensor optoforce("optoforce");
  EXPECT_THAT(refusal_to_open("bota:" + optoforce.path()), HasSubstr("none are its frames"));
  EXPECT_THAT(refusal_to_open("ft300:" + optoforce.path()), HasSubstr("does not answer"));
  const RunningSerialSensor bota("bota");
  const auto first = open_device(bota.uri());
  EXPECT_THAT(refusal_to_open(bota.uri()), HasSubstr("another program has"));
}

}  // namespace
}  // namespace kerf::drivers
