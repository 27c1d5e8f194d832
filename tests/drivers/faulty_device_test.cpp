#include "kerf/drivers/faulty_device.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    (void)parse_faults(text);
    return "";
  } catch (const DeviceError& error) {
    return error.what();
  }
}

TEST(ParseFaults, ReadsEachKind) {
  const auto faults =
      parse_faults("unplug@2.5,stall@1.0:50ms,nan@3.0,jump@4.0:-20mm,late@5s:0.003s,nan@6:20ms");
  ASSERT_EQ(faults.size(), 6U);
  EXPECT_EQ(faults[0].kind, Fault::Kind::unplug);
  EXPECT_EQ(faults[0].at_s, 2.5);
  EXPECT_EQ(faults[1].kind, Fault::Kind::stall);
  EXPECT_DOUBLE_EQ(faults[1].size, 0.05);
  EXPECT_EQ(faults[2].size, 0.0);
  EXPECT_DOUBLE_EQ(faults[3].size, -0.02);
  EXPECT_EQ(faults[4].kind, Fault::Kind::late);
  EXPECT_EQ(faults[4].at_s, 5.0);
  EXPECT_DOUBLE_EQ(faults[4].size, 0.003);
  EXPECT_DOUBLE_EQ(faults[5].size, 0.02);
}

TEST(ParseFaults, RefusesWhatItCannotReadAndSaysWhatItExpects) {
  for (const auto* text :
       {"", "unplug", "unplug@", "unplug@x", "unplug@2:3ms", "stall@1", "stall@1:50", "stall@1:50mm",
        "stall@1:-5ms", "jump@4:20ms", "melt@1", "nan@-1", "nan@1,", "stall@1:1e9s", "nan@2m"}) {
    EXPECT_THAT(refusal(text), HasSubstr("expected KIND@SECONDS")) << text;
  }
}

TEST(FaultsOfADevice, AreRefusedWhereItIsOpened) {
  EXPECT_THROW((void)open_device("sim:scissors?fault=melt@1"), DeviceError);
  EXPECT_NO_THROW((void)open_device("sim:scissors?fault=nan@1&seed=3"));
}

/// The simulated scissors with faults, read once a millisecond while time stands still but for the faults.
class Faulty : public testing::Test {
 protected:
  void open(const std::string& faults) {
    Surroundings surroundings;
    surroundings.pass_time = [this](double seconds) { passed_s_ += seconds; };
    device_ = open_device("sim:scissors?noise=off&fault=" + faults, std::move(surroundings));
    sound_ = open_device("sim:scissors?noise=off");
  }
  /// Reads both devices at tick after tick up to a time; returns the last answer of the faulty one.
  Status read_until(double time_s) {
    Status status = Status::ok;
    for (; tick_ <= std::llround(1e3 * time_s); ++tick_) {
      const double now_s = 1e-3 * static_cast<double>(tick_);
      status = device_->read(now_s, sample_);
      (void)sound_->read(now_s, expected_);
    }
    return status;
  }

  std::unique_ptr<Device> device_;
  std::unique_ptr<Device> sound_;
  Sample sample_;
  Sample expected_;
  double passed_s_ = 0.0;
  std::int64_t tick_ = 0;
};

TEST_F(Faulty, IsSoundUntilItsMoment) {
  open("unplug@0.5");
  EXPECT_EQ(read_until(0.499), Status::ok);
  EXPECT_EQ(sample_.position, expected_.position);
  EXPECT_EQ(read_until(0.5), Status::lost);
  EXPECT_EQ(device_->write({}), Status::lost);
  EXPECT_EQ(read_until(0.6), Status::lost) << "it does not come back";
}

TEST_F(Faulty, StallsInOneReadAndAnswersWithTheStateAtItsEnd) {
  open("stall@0.7:50ms");
  EXPECT_EQ(read_until(0.7), Status::ok);
  EXPECT_DOUBLE_EQ(passed_s_, 0.05);
  const double stalled = sample_.position[0];
  (void)sound_->read(0.75, expected_);
  EXPECT_EQ(stalled, expected_.position[0]);
  tick_ = 751;
  (void)read_until(0.8);
  EXPECT_DOUBLE_EQ(passed_s_, 0.05) << "once";
}

TEST_F(Faulty, IsLateInOneWrite) {
  open("late@0.2:3ms");
  (void)read_until(0.199);
  EXPECT_EQ(device_->write({}), Status::ok);
  EXPECT_EQ(passed_s_, 0.0);
  (void)read_until(0.2);
  EXPECT_EQ(device_->write({}), Status::ok);
  EXPECT_EQ(device_->write({}), Status::ok);
  EXPECT_DOUBLE_EQ(passed_s_, 0.003);
}

TEST_F(Faulty, GivesNoNumberForOneSampleOrForAWhile) {
  open("nan@0.1,nan@0.2:5ms");
  int bad = 0;
  for (int tick = 0; tick < 300; ++tick) {
    (void)read_until(1e-3 * tick);
    bad += std::isnan(sample_.position[0]) ? 1 : 0;
  }
  EXPECT_EQ(bad, 1 + 5);
}

TEST_F(Faulty, JumpsByATravelAtTheHandle) {
  open("jump@0.1:20mm");
  (void)read_until(0.1);
  const double lever_m = device_->info().axes[0].lever;
  EXPECT_NEAR(sample_.position[0] - expected_.position[0], 0.02 / lever_m, 1e-12);
  EXPECT_GT(sample_.velocity[0] - expected_.velocity[0], 10.0) << "a driver's velocity jumps with it";
  (void)read_until(0.5);
  EXPECT_NEAR(sample_.position[0] - expected_.position[0], 0.02 / lever_m, 1e-12);
  EXPECT_NEAR(sample_.velocity[0], expected_.velocity[0], 1e-9);
}

TEST(FaultyDevice, SleepsWhereNobodyMovesTheTime) {
  const auto device = open_device("sim:scissors?fault=stall@0:20ms");
  timespec before{};
  timespec after{};
  Sample sample;
  clock_gettime(CLOCK_MONOTONIC, &before);
  (void)device->read(0.0, sample);
  clock_gettime(CLOCK_MONOTONIC, &after);
  EXPECT_GE(static_cast<double>(after.tv_sec - before.tv_sec) +
                1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec),
            0.02)
      << "a sleep is never shorter";
}

TEST(Release, LeavesTheSimulatedDeviceWithoutForceFromThenOn) {
  const auto opened = [](bool released) {
    const auto device = open_device("sim:scissors?hand=off&encoder=off&noise=off");
    Sample sample;
    (void)device->read(0.0, sample);
    (void)device->write({1.0, 0.0});
    if (released) device->release(0.01);
    (void)device->read(0.01, sample);
    const double at_release = sample.velocity[0];
    (void)device->read(0.02, sample);
    return std::pair{at_release, sample.position[0]};
  };
  const auto [speed_held, place_held] = opened(false);
  const auto [speed_released, place_released] = opened(true);
  EXPECT_EQ(speed_released, speed_held) << "until then the force holds";
  EXPECT_LT(place_released, place_held);
}

TEST(Release, EndsWithTheNextWrite) {
  const auto device = open_device("sim:scissors?hand=off&encoder=off&noise=off");
  const auto other = open_device("sim:scissors?hand=off&encoder=off&noise=off");
  Sample sample;
  Sample expected;
  device->release(0.0);
  (void)device->write({1.0, 0.0});
  (void)other->write({1.0, 0.0});
  (void)device->read(0.01, sample);
  (void)other->read(0.01, expected);
  EXPECT_EQ(sample.position, expected.position);
}

}  // namespace
}  // namespace kerf::drivers
