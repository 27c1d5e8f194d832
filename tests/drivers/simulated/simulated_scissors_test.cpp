#include "kerf/drivers/simulated_scissors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.h"

namespace kerf::drivers {
namespace {

constexpr double period_s = 1e-3;

/// Samples of a device at 1 kHz under a force that never changes.
std::vector<Sample> samples(Device& device, int ticks, const Axes& force = {}) {
  std::vector<Sample> all(static_cast<std::size_t>(ticks));
  for (int tick = 0; tick < ticks; ++tick) {
    EXPECT_EQ(device.read(tick * period_s, all[static_cast<std::size_t>(tick)]), Status::ok);
    EXPECT_EQ(device.write(force), Status::ok);
  }
  return all;
}

/// A spring on theta that opens the blades below 0.5 rad.
Surroundings spring(double stiffness_n_per_rad) {
  Surroundings around;
  around.tissue[0] = [=](double angle, double, double) {
    return stiffness_n_per_rad * std::max(0.0, 0.5 - angle);
  };
  return around;
}

TEST(Scissors, AreTheHapticScissorsOfThePapers) {
  const auto device = open_device("sim:scissors");
  const auto& axes = device->info().axes;
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_TRUE(device->info().measures_force);
  EXPECT_EQ(axes[0].name, "theta");
  EXPECT_NEAR(axes[0].resolution, 0.056 * std::acos(-1.0) / 180.0, 1e-15);
  EXPECT_NEAR(axes[0].force_limit * axes[0].lever, 0.280, 1e-12) << "280 mN·m";
  EXPECT_EQ(axes[1].name, "x_s");
  EXPECT_EQ(axes[1].resolution, 0.0152e-3);
  EXPECT_EQ(axes[1].force_limit, 159.0);
  ASSERT_EQ(list_devices().size(), 4U);
  EXPECT_EQ(list_devices()[0].uri, "sim:scissors");
}

TEST(Scissors, AreLedAlongOneWayForAsLongAsItIsAsked) {
  const auto place = [](const char* uri, double time_s) {
    const auto device = open_device(uri);
    Sample sample;
    for (int tick = 0; tick * period_s <= time_s; ++tick) {
      EXPECT_EQ(device->read(tick * period_s, sample), Status::ok);
      EXPECT_EQ(device->write({}), Status::ok);
    }
    return sample.position[0] / (std::acos(-1.0) / 180.0);
  };
  // Coulomb friction of 0.1 N holds the handle off 500 N/m by 0.31 deg, and the encoder steps by 0.056.
  constexpr double sticks_deg = 0.31 + 0.056;
  const auto strokes = "sim:scissors?target=strokes&open=30deg&close=10deg&stroke=0.8s&pause=0.2s";
  EXPECT_NEAR(place(strokes, 0.0), 30.0, 0.1);
  EXPECT_NEAR(place(strokes, 1.1), 10.0, sticks_deg) << "closed, before it opens again";
  EXPECT_NEAR(place(strokes, 100.1), 30.0, sticks_deg) << "in step after fifty times";
  EXPECT_NEAR(
      place("sim:scissors?target=strokes&begins=closed&open=30deg&close=10deg&stroke=0.8s&pause=0.2s", 1.1),
      30.0, sticks_deg);
  EXPECT_NEAR(place("sim:scissors?target=sine&open=30deg&close=10deg&stroke=1s", 1.0), 10.0, 0.5);
  EXPECT_THROW((void)open_device("sim:scissors?target=circle"), DeviceError);
  EXPECT_THROW((void)open_device("sim:scissors?begins=ajar"), DeviceError);
}

TEST(Scissors, AreTheSameBitForBitWithOneSeed) {
  const auto one = open_device("sim:scissors?seed=5", spring(6.0));
  const auto same = open_device("sim:scissors?seed=5", spring(6.0));
  const auto other = open_device("sim:scissors?seed=6", spring(6.0));
  const auto first = samples(*one, 3000);
  const auto again = samples(*same, 3000);
  const auto elsewhere = samples(*other, 3000);
  bool differs = false;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(first[i].position[axis]),
                std::bit_cast<std::uint64_t>(again[i].position[axis]));
      ASSERT_EQ(first[i].velocity[axis], again[i].velocity[axis]);
      ASSERT_EQ(first[i].force_measured[axis], again[i].force_measured[axis]);
      differs = differs || first[i].position[axis] != elsewhere[i].position[axis];
    }
  }
  EXPECT_TRUE(differs);
}

TEST(Scissors, TellPositionsInStepsOfTheirEncoder) {
  const auto device = open_device("sim:scissors");
  const double step = device->info().axes[0].resolution;
  for (const Sample& sample : samples(*device, 2000)) {
    const double count = sample.position[0] / step;
    ASSERT_NEAR(count, std::round(count), 1e-9);
  }
}

TEST(Scissors, MeasureWhatTheTissueExerts) {
  const auto device = open_device("sim:scissors?noise=off&encoder=off", spring(6.0));
  double largest = 0.0;
  for (const Sample& sample : samples(*device, 2000)) {
    ASSERT_NEAR(sample.force_measured[0], 6.0 * std::max(0.0, 0.5 - sample.position[0]), 1e-3);
    largest = std::max(largest, sample.force_measured[0]);
  }
  EXPECT_GT(largest, 1.5) << "the hand has closed them into the tissue";
}

TEST(Scissors, MeasureWithTheNoiseOfTheirSensor) {
  const auto device = open_device("sim:scissors");
  double square = 0.0;
  const auto all = samples(*device, 5000);
  for (const Sample& sample : all) square += sample.force_measured[0] * sample.force_measured[0];
  // White noise of 20 mN and a step of 2 mN (variance step^2 / 12).
  const double expected = std::sqrt(0.02 * 0.02 + 0.002 * 0.002 / 12.0);
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(all.size())), expected, 0.05 * expected);
}

TEST(Scissors, YieldToTheHandByTheForceOverItsStiffness) {
  const auto device = open_device("sim:scissors?encoder=off&grip=400N/m&pause=100s");
  const double rest = samples(*device, 2000).back().position[0];
  const auto pushed_device = open_device("sim:scissors?encoder=off&grip=400N/m&pause=100s");
  const double pushed = samples(*pushed_device, 4000, {2.0}).back().position[0];
  // Coulomb friction of 0.1 N holds it within 0.1 / K of there.
  EXPECT_NEAR((pushed - rest) * SimulatedScissors::lever_m, 2.0 / 400.0, 0.1 / 400.0);
}

TEST(Scissors, SwingInAHandAsMassAndDampingOfItSay) {
  // A push that begins: the heavier hand gives way later, the damped one swings back less.
  const auto swing = [](const std::string& hand) {
    const auto device = open_device("sim:scissors?encoder=off&grip=400N/m&pause=100s&" + hand);
    const double rest = samples(*device, 1).back().position[0];
    double first_m = 0.0;
    double most_m = 0.0;
    const auto pushed = samples(*device, 2000, {4.0});
    for (std::size_t tick = 0; tick < pushed.size(); ++tick) {
      most_m = std::max(most_m, (pushed[tick].position[0] - rest) * SimulatedScissors::lever_m);
      if (tick == 10) first_m = most_m;
    }
    return std::pair{first_m, most_m};
  };
  const auto [light_first, light_most] = swing("mass=0kg&damping=0Ns/m");
  const auto [heavy_first, heavy_most] = swing("mass=2kg&damping=0Ns/m");
  const auto [damped_first, damped_most] = swing("mass=2kg&damping=200Ns/m");
  EXPECT_LT(heavy_first, 0.5 * light_first);
  EXPECT_GT(heavy_most, 1.3 * 4.0 / 400.0) << "it swings past where it will rest";
  EXPECT_NEAR(damped_most, 4.0 / 400.0, 0.1 * 4.0 / 400.0);
}

TEST(Scissors, TellTheirSpeedAsAFilteredDifference) {
  const auto device = open_device("sim:scissors?encoder=off&variation=0&hand=off");
  const auto all = samples(*device, 200, {0.5});
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double difference = (all[i].position[0] - all[i - 1].position[0]) / period_s;
    const double share = 1.0 - std::exp(-2.0 * std::acos(-1.0) * 20.0 * period_s);
    ASSERT_NEAR(all[i].velocity[0], all[i - 1].velocity[0] + share * (difference - all[i - 1].velocity[0]),
                1e-9);
  }
  EXPECT_GT(all.back().velocity[0], 0.0) << "a positive force opens";
}

TEST(Scissors, LimitTheForceOfTheirMotors) {
  const auto strong = open_device("sim:scissors?encoder=off");
  const auto limit = open_device("sim:scissors?encoder=off");
  EXPECT_EQ(samples(*strong, 300, {1e6}).back().position[0], samples(*limit, 300, {7.58}).back().position[0]);
}

TEST(Scissors, TakeNoForceThatIsNotFinite) {
  const auto device = open_device("sim:scissors?encoder=off&pause=100s");
  Sample sample;
  EXPECT_EQ(device->read(0.0, sample), Status::ok);
  EXPECT_EQ(device->write({5.0}), Status::ok);
  EXPECT_EQ(device->write({std::numeric_limits<double>::quiet_NaN()}), Status::fault);
  const double before = sample.position[0];
  EXPECT_EQ(device->read(0.2, sample), Status::ok);
  EXPECT_EQ(sample.position[0], before) << "neither the bad force nor the one before it acts";
}

TEST(Scissors, FeelNoForceBeforeTheFirstWrite) {
  const auto device = open_device("sim:scissors?encoder=off&hand=off");
  Sample first;
  Sample later;
  EXPECT_EQ(device->read(0.0, first), Status::ok);
  EXPECT_EQ(device->read(1.0, later), Status::ok);
  EXPECT_EQ(first.position, later.position);
}

TEST(Scissors, MoveTheSameHoweverOftenTheyAreRead) {
  const auto often = open_device("sim:scissors?encoder=off", spring(6.0));
  const auto seldom = open_device("sim:scissors?encoder=off", spring(6.0));
  const double now = samples(*often, 1001).back().position[0];
  Sample sample;
  EXPECT_EQ(seldom->read(1.0, sample), Status::ok);
  EXPECT_EQ(sample.position[0], now) << "the physics have their own period";
}

TEST(Scissors, AllocateNothingInATick) {
  const auto device = open_device("sim:scissors", spring(6.0));
  Sample sample;
  const std::size_t before = test::allocations();
  for (int tick = 0; tick < 5000; ++tick) {
    (void)device->read(tick * period_s, sample);
    (void)device->write({0.5, 0.1});
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace kerf::drivers
