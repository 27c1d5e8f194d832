#include "kerf/drivers/sensed_device.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/allocation_counter.h"

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;

AxisInfo axis(std::string name, std::string force_unit) {
  return {.name = std::move(name), .position_unit = "m", .force_unit = std::move(force_unit)};
}

/// A device or sensor of whose answer the test disposes.
class Scripted final : public Device {
 public:
  explicit Scripted(DeviceInfo info) : info_(std::move(info)) {}
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double, Sample& sample) noexcept override {
    sample = answer;
    return status;
  }
  [[nodiscard]] Status write(const Axes& force) noexcept override {
    written = force;
    return Status::ok;
  }
  void release(double) noexcept override { released = true; }
  [[nodiscard]] std::vector<Figure> figures() const override { return {{info_.uri, 1.0, "1"}}; }

  Sample answer;
  Status status = Status::ok;
  Axes written{};
  bool released = false;

 private:
  DeviceInfo info_;
};

struct Pair {
  explicit Pair(std::vector<AxisInfo> axes, std::vector<ForceMount> mounts = {}) {
    auto one = std::make_unique<Scripted>(DeviceInfo{.uri = "tool",
                                                     .axes = std::move(axes),
                                                     .channels = {{.name = "age", .unit = "s"}},
                                                     .configuration = "length = 1\n"});
    auto other = std::make_unique<Scripted>(
        DeviceInfo{.uri = "cell",
                   .axes = {axis("x", "N"), axis("y", "N"), axis("z", "N"), axis("rx", "N·m"),
                            axis("ry", "N·m"), axis("rz", "N·m")},
                   .channels = {{.name = "force_age", .unit = "s"}, {.name = "force_scan", .unit = "1"}},
                   .measures_force = true,
                   .configuration = "serial = 1\n",
                   .mounts = std::move(mounts)});
    tool = one.get();
    cell = other.get();
    cell->answer.force_measured = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
    cell->answer.channels = {0.001, 77.0};
    tool->answer.channels = {0.5};
    device = std::make_unique<SensedDevice>(std::move(one), std::move(other));
  }
  Scripted* tool = nullptr;
  Scripted* cell = nullptr;
  std::unique_ptr<SensedDevice> device;
  Sample sample;
};

std::string refusal(std::vector<AxisInfo> axes, std::vector<ForceMount> mounts) {
  try {
    const Pair pair(std::move(axes), std::move(mounts));
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "taken";
}

TEST(SensedDevice, TakesTheForceOfAnAxisFromTheComponentOfItsName) {
  Pair pair({axis("z", "N"), axis("rx", "N·m"), axis("grip", "N")});
  EXPECT_TRUE(pair.device->info().measures_force);
  EXPECT_EQ(pair.device->read(0.0, pair.sample), Status::ok);
  EXPECT_EQ(pair.sample.force_measured[0], 3.0);
  EXPECT_EQ(pair.sample.force_measured[1], 4.0);
  EXPECT_TRUE(std::isnan(pair.sample.force_measured[2])) << "nobody measured it";
}

TEST(SensedDevice, FollowsTheMountsOfTheSensor) {
  Pair pair({axis("theta", "N"), axis("x", "N"), axis("q", "N·m")},
            {{.axis = "theta", .component = 5, .sign = -1.0, .lever_m = 0.04},
             {.axis = "x", .component = 1},
             {.axis = "q", .component = 2, .lever_m = 0.1},
             {.axis = "elsewhere", .component = 0}});
  EXPECT_EQ(pair.device->read(0.0, pair.sample), Status::ok);
  EXPECT_DOUBLE_EQ(pair.sample.force_measured[0], -6.0 / 0.04);
  EXPECT_EQ(pair.sample.force_measured[1], 2.0);
  EXPECT_DOUBLE_EQ(pair.sample.force_measured[2], 3.0 * 0.1);
}

TEST(SensedDevice, AddsTheSensorsChannelsBehindItsOwn) {
  Pair pair({axis("x", "N")});
  const auto& channels = pair.device->info().channels;
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[0].name, "age");
  EXPECT_EQ(channels[2].name, "force_scan");
  EXPECT_EQ(pair.device->read(0.0, pair.sample), Status::ok);
  EXPECT_EQ(pair.sample.channels[0], 0.5);
  EXPECT_EQ(pair.sample.channels[1], 0.001);
  EXPECT_EQ(pair.sample.channels[2], 77.0);
  EXPECT_EQ(pair.device->info().configuration,
            "length = 1\n\n[sensor]\nuri = \"cell\"\nmodel = \"\"\nserial = 1\n");
  EXPECT_EQ(pair.device->figures().size(), 2U);
}

TEST(SensedDevice, TakesAPauseOfTheSensorForAGapAndNotForAFault) {
  Pair pair({axis("x", "N")});
  pair.cell->status = Status::fault;
  EXPECT_EQ(pair.device->read(0.0, pair.sample), Status::ok);
  EXPECT_TRUE(std::isnan(pair.sample.force_measured[0]));
  EXPECT_TRUE(pair.sample.sensor_fault);
  pair.cell->status = Status::lost;
  EXPECT_EQ(pair.device->read(0.0, pair.sample), Status::lost);
  pair.cell->status = Status::ok;
  pair.tool->status = Status::fault;
  EXPECT_EQ(pair.device->read(0.0, pair.sample), Status::fault);
  EXPECT_FALSE(pair.sample.sensor_fault);
}

TEST(SensedDevice, HandsForcesAndReleasesToTheDevice) {
  Pair pair({axis("x", "N")});
  EXPECT_EQ(pair.device->write({3.0}), Status::ok);
  EXPECT_EQ(pair.tool->written[0], 3.0);
  EXPECT_EQ(pair.cell->written[0], 0.0);
  pair.device->release(0.0);
  EXPECT_TRUE(pair.tool->released);
}

TEST(SensedDevice, RefusesASensorThatMeasuresNoneOfItsAxes) {
  EXPECT_THAT(refusal({axis("theta", "N")}, {}), AllOf(HasSubstr("[axes]"), HasSubstr("theta = \"fx\"")));
}

TEST(SensedDevice, RefusesUnitsThatDoNotFit) {
  EXPECT_THAT(refusal({axis("theta", "N")}, {{.axis = "theta", .component = 5}}),
              HasSubstr("give the lever"));
  EXPECT_THAT(refusal({axis("theta", "N")}, {{.axis = "theta", .component = 0, .lever_m = 0.1}}),
              HasSubstr("leave out lever_m"));
}

TEST(SensedDevice, RefusesADeviceThatMeasuresNothingAsSensor) {
  auto tool = std::make_unique<Scripted>(DeviceInfo{.uri = "a", .axes = {axis("x", "N")}});
  auto blind = std::make_unique<Scripted>(DeviceInfo{.uri = "b", .axes = {axis("x", "N")}});
  EXPECT_THROW(SensedDevice(std::move(tool), std::move(blind)), DeviceError);
}

TEST(SensedDevice, RefusesVirtualTimeForASensorOfHardware) {
  Surroundings surroundings;
  surroundings.pass_time = [](double) {};
  try {
    (void)open_device("sim:scissors", "u6:0?calibration=examples/u6.calibration.toml",
                      std::move(surroundings));
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("leave out --virtual"));
  }
}

TEST(SensedDevice, MeasuresByAnotherSimulatedDeviceToo) {
  const auto device = open_device("sim:pose6?noise=off", "sim:pose6", {});
  Sample sample;
  EXPECT_EQ(device->read(0.001, sample), Status::ok);
  EXPECT_TRUE(std::isfinite(sample.force_measured[5]));
}

TEST(SensedDevice, IsTheDeviceItselfWhereNoSensorIsNamed) {
  const auto device = open_device("sim:pose6", "", {});
  ASSERT_TRUE(device);
  EXPECT_EQ(device->info().uri, "sim:pose6");
}

TEST(SensedDevice, AllocatesNothingInATick) {
  Pair pair({axis("x", "N"), axis("y", "N")});
  const test::NoAllocation guard;
  for (int tick = 0; tick < 1000; ++tick) (void)pair.device->read(1e-3 * tick, pair.sample);
}

}  // namespace
}  // namespace kerf::drivers
