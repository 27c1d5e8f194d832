#include "kerf/drivers/simulated_pose6.h"

#include <cmath>

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

TEST(Pose6, RefusesOptionsThatItDoesNotHave) {
  EXPECT_THROW((void)open_device("sim:pose6?open=30deg"), DeviceError);
  EXPECT_THROW((void)open_device("sim:pose6?reach=3m"), DeviceError);
}

}  // namespace
}  // namespace kerf::drivers
