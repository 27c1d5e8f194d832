#include "kerf/drivers/simulated_pose6.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

TEST(Pose6, HasThreeTranslationsAndThreeRotations) {
  const auto device = open_device("sim:pose6");
  const auto& axes = device->info().axes;
  ASSERT_EQ(axes.size(), 6U);
  for (std::size_t at = 0; at < 6; ++at) {
    EXPECT_EQ(axes[at].position_unit, at < 3 ? "m" : "rad");
    EXPECT_EQ(axes[at].force_unit, at < 3 ? "N" : "N·m");
  }
  EXPECT_TRUE(device->info().channels.empty());
}

TEST(Pose6, IsHeldByItsHandAgainstAForce) {
  const auto device = open_device("sim:pose6?reach=0m&swing=0deg&noise=off&encoder=off");
  Sample sample;
  (void)device->write({2.0, 0.0, 0.0, 0.0, 0.2, 0.0});
  (void)device->read(3.0, sample);
  // Coulomb friction holds a part of it: 0.05 N, 1 mN·m.
  EXPECT_NEAR(sample.position[0], 2.0 / 500.0, 0.05 / 500.0);
  EXPECT_NEAR(sample.position[4], 0.2 / 1.0, 1e-3 / 1.0);
  EXPECT_EQ(sample.position[1], 0.0) << "no axis acts on another";
}

TEST(Pose6, GivesTheTruthBesideWhatItsEncodersSay) {
  const auto device = open_device("sim:pose6?truth=on");
  ASSERT_EQ(device->info().channels.size(), 12U);
  EXPECT_EQ(device->info().channels[0].name, "x_true");
  EXPECT_EQ(device->info().channels[11].name, "rz_force_true");
  EXPECT_EQ(device->info().channels[11].unit, "N·m");
  Sample sample;
  double largest = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    (void)device->read(1e-3 * tick, sample);
    for (std::size_t at = 0; at < 6; ++at) {
      const double step = device->info().axes[at].resolution;
      largest = std::max(largest, std::abs(sample.position[at] - sample.channels[at]) / step);
    }
  }
  EXPECT_LE(largest, 0.5 + 1e-9) << "an encoder is off by half a step at most";
  EXPECT_GT(largest, 0.4);
}

TEST(Pose6, IsAToolOfItsOwnWithTheHandsMassOnTop) {
  const auto device = open_device("sim:pose6?hand=off");
  for (std::size_t at = 0; at < 6; ++at) {
    ASSERT_TRUE(device->info().axes[at].mechanics);
    const Mechanics& tool = *device->info().axes[at].mechanics;
    EXPECT_EQ(tool.mass_kg, at < 3 ? 0.15 : 2.5e-4);
    EXPECT_GT(tool.coulomb_n, 0.0);
  }
  // Free, from rest: v = F t / m, less friction, b t / m = 0.013 and f_c t / m = 3 mm/s.
  Sample sample;
  const auto free = open_device("sim:pose6?hand=off&truth=on&noise=off&encoder=off");
  (void)free->write({0.3, 0.0, 0.0, 0.0, 0.0, 0.0});
  (void)free->read(0.01, sample);
  EXPECT_NEAR(sample.channels[0], 0.5 * (0.3 - 0.05) / 0.15 * 0.01 * 0.01, 2e-6);
}

TEST(Pose6, HoldsMoreFirmlyByAFirmerGrip) {
  const auto device = open_device("sim:pose6?reach=0m&swing=0deg&noise=off&encoder=off&grip=1000N/m");
  Sample sample;
  (void)device->write({2.0, 0.0, 0.0, 0.0, 0.2, 0.0});
  (void)device->read(3.0, sample);
  EXPECT_NEAR(sample.position[0], 2.0 / 1000.0, 0.05 / 1000.0);
  EXPECT_NEAR(sample.position[4], 0.2 / 2.0, 1e-3 / 2.0) << "rotations in proportion";
}

TEST(Pose6, SwaysAboutEachAxisAtAPaceOfItsOwnAndARadianAhead) {
  const auto device = open_device("sim:pose6?noise=off&encoder=off&reach=0.02m&swing=10deg");
  constexpr std::array frequencies_hz{0.23, 0.31, 0.47, 0.29, 0.41, 0.59};
  Sample sample;
  for (const double time_s : {2.0, 3.0}) {
    (void)device->read(time_s, sample);
    for (std::size_t at = 0; at < 6; ++at) {
      const double amplitude = at < 3 ? 0.02 : 10.0 * std::numbers::pi / 180.0;
      const double angle = 2.0 * std::numbers::pi * frequencies_hz[at] * time_s + static_cast<double>(at);
      EXPECT_NEAR(sample.position[at], amplitude * std::sin(angle), 0.05 * amplitude) << at;
    }
  }
}

TEST(Pose6, FollowsKeyframesOfAllItsAxes) {
  const auto device = open_device(
      "sim:pose6?noise=off&encoder=off&path=0s:0:0:100mm:0:0:0deg,1s:0:-40:100mm:0:0:60deg,2s:0:0:100mm:0:0:"
      "0deg"
      "&repeat=on");
  Sample sample;
  (void)device->read(0.0, sample);
  EXPECT_EQ(sample.position[2], 0.1) << "it begins at the first";
  const double turned = 60.0 * std::numbers::pi / 180.0;
  for (const double time_s : {1.0, 3.0}) {
    (void)device->read(time_s, sample);
    EXPECT_NEAR(sample.position[1], -0.04, 2e-3);
    EXPECT_NEAR(sample.position[2], 0.1, 1e-6);
    EXPECT_NEAR(sample.position[5], turned, 0.05);
  }
}

TEST(Pose6, RefusesAPathThatItCannotFollow) {
  const std::string base = "sim:pose6?path=0s:0:0:0mm:0:0:0deg";
  EXPECT_NO_THROW((void)open_device(base));
  for (const char* more : {",1s:0:0:201mm:0:0:0deg", ",1s:0:0:0mm:0:0:120deg", ",0s:0:0:0mm:0:0:0deg",
                           "&reach=0.01m", ",1s:0:0:1mm:0:0:0deg&repeat=on", ",x"}) {
    EXPECT_THROW((void)open_device(base + more), DeviceError) << more;
  }
  EXPECT_THROW((void)open_device("sim:pose6?repeat=on"), DeviceError);
}

TEST(Pose6, RefusesOptionsThatItDoesNotHave) {
  EXPECT_THROW((void)open_device("sim:pose6?open=30deg"), DeviceError);
  EXPECT_THROW((void)open_device("sim:pose6?reach=3m"), DeviceError);
}

}  // namespace
}  // namespace kerf::drivers
