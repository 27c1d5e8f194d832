#include "kerf/drivers/simulated_premium.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/allocation_counter.h"

namespace kerf::drivers {
namespace {

using mechanisms::Premium;
using testing::AllOf;
using testing::HasSubstr;
using Vector = Premium::Vector;

constexpr double period_s = 1e-3;
constexpr double sub_step_s = SimulatedMechanism::sub_step_s;
const std::string bare = "sim:premium?hand=off&friction=off&encoder=off&noise=off";

Vector angles(const Sample& sample) { return {sample.position[0], sample.position[1], sample.position[2]}; }
Vector tip(const Sample& sample) { return {sample.channels[0], sample.channels[1], sample.channels[2]}; }

std::vector<Sample> samples(Device& device, int ticks, const Axes& torque = {}) {
  std::vector<Sample> all(static_cast<std::size_t>(ticks));
  for (int tick = 0; tick < ticks; ++tick) {
    EXPECT_EQ(device.read(tick * period_s, all[static_cast<std::size_t>(tick)]), Status::ok);
    EXPECT_EQ(device.write(torque), Status::ok);
  }
  return all;
}

/// The energy at the end of every sub-step, from the step that led there.
std::vector<double> energies(const std::vector<Sample>& all, const Premium& arm) {
  std::vector<double> energy;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Vector q = angles(all[i]);
    const Vector speed = (q - angles(all[i - 1])) / sub_step_s;
    energy.push_back(arm.kinetic_energy(q, speed) + arm.potential_energy(q));
  }
  return energy;
}

/// The samples of every sub-step for `seconds` after a push of 20 ms.
std::vector<Sample> coasting(const std::string& uri, const Axes& push, double seconds) {
  const auto device = open_device(uri);
  Sample sample;
  (void)device->write(push);
  (void)device->read(0.02, sample);
  (void)device->write({});
  std::vector<Sample> all;
  for (int i = 0; i <= static_cast<int>(seconds / sub_step_s); ++i) {
    (void)device->read(0.02 + i * sub_step_s, sample);
    all.push_back(sample);
  }
  return all;
}

std::string refusal(const std::string& uri) {
  try {
    (void)open_device(uri);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(SimulatedPremium, HasThreeJointsAndTellsItsTip) {
  const auto device = open_device("sim:premium");
  const DeviceInfo& info = device->info();
  ASSERT_EQ(info.axes.size(), 3U);
  for (const AxisInfo& axis : info.axes) {
    EXPECT_EQ(axis.position_unit, "rad");
    EXPECT_EQ(axis.force_unit, "N·m");
  }
  EXPECT_NEAR(info.axes[1].resolution * Premium::upper_arm_m, 0.03e-3, 0.001e-3) << "nominal, at the tip";
  EXPECT_NEAR(info.axes[2].force_limit / Premium::forearm_m, 8.5, 0.01) << "N at the tip";
  ASSERT_EQ(info.channels.size(), 3U);
  EXPECT_EQ(info.channels[2].name, "tip_z");
  for (const Sample& sample : samples(*device, 2000)) {
    ASSERT_LT((tip(sample) - Premium::tip(angles(sample))).norm(), 1e-16);
  }
}

TEST(SimulatedPremium, AcceleratesByTheInverseOfItsInertia) {
  const auto device = open_device(bare);
  Sample sample;
  (void)device->write({0.5, -0.3, 0.2});
  (void)device->read(20 * sub_step_s, sample);
  const Vector expected = Premium().acceleration(Vector::Zero(), Vector::Zero(), {0.5, -0.3, 0.2});
  // Twenty steps, each with the speed at its end: 1 + 2 + ... + 20.
  const Vector acceleration = angles(sample) / (sub_step_s * sub_step_s * 210.0);
  EXPECT_LT((acceleration - expected).norm(), 1e-3 * expected.norm());
}

TEST(SimulatedPremium, KeepsItsEnergyWhereNothingTakesIt) {
  const auto energy =
      energies(coasting(bare + "&gravity=off", {0.1, 0.05, -0.03}, 0.5), Premium({.with_gravity = false}));
  for (std::size_t i = 1; i < energy.size(); ++i) ASSERT_LT(energy[i], energy[i - 1] * (1.0 + 1e-6));
  EXPECT_GT(energy.back(), 0.999 * energy.front());
}

TEST(SimulatedPremium, TradesHeightForSpeedUnderGravity) {
  const Premium arm;
  const auto motion = coasting(bare, {0.1, 0.03, 0.03}, 0.25);
  const auto energy = energies(motion, arm);
  const auto [lowest, highest] = std::minmax_element(energy.begin(), energy.end());
  const double traded =
      std::abs(arm.potential_energy(angles(motion.back())) - arm.potential_energy(angles(motion.front())));
  EXPECT_LT(*highest - *lowest, 0.02 * traded);
  EXPECT_GT(traded, 1e-4);
}

TEST(SimulatedPremium, IsStoppedByFriction) {
  const auto motion = coasting("sim:premium?hand=off&encoder=off&gravity=off", {0.1, 0.05, -0.06}, 0.6);
  const auto energy = energies(motion, Premium({.with_gravity = false}));
  for (std::size_t i = 1; i < energy.size(); ++i) ASSERT_LE(energy[i], energy[i - 1] + 1e-18);
  EXPECT_LT((angles(motion.back()) - angles(motion[motion.size() - 1000])).norm(), 1e-12) << "it sticks";
}

TEST(SimulatedPremium, SticksUnderATorqueBelowItsFriction) {
  const auto device = open_device("sim:premium?hand=off&encoder=off&gravity=off");
  const auto all = samples(*device, 1000, {0.009, -0.009, 0.009});
  EXPECT_LT(angles(all.back()).norm(), 1e-9) << "rad";
}

TEST(SimulatedPremium, ReachesTheWaypointsOfItsHand) {
  const auto device =
      open_device("sim:premium?path=0:0:0mm,30:-20:10mm,-30:20:0mm&stroke=0.5s&pause=0.5s&encoder=off");
  const std::vector<Vector> waypoints{
      {0.0, 0.0, 0.0}, {0.03, -0.02, 0.01}, {-0.03, 0.02, 0.0}, {0.0, 0.0, 0.0}};
  const auto all = samples(*device, 3500);
  for (std::size_t at = 0; at < waypoints.size(); ++at) {
    const double off = (tip(all[1000 * at + 490]) - waypoints[at]).norm();
    // What weight and friction of the joints take of a hand of 500 N/m.
    EXPECT_LT(off, 0.3e-3) << "waypoint " << at;
  }
}

TEST(SimulatedPremium, YieldsToTheHandByTheForceOverItsStiffness) {
  const auto device = open_device("sim:premium?path=0:0:0mm&encoder=off&gravity=off&grip=400N/m");
  const Vector pushed = tip(samples(*device, 3000, {2.0 * 0.215, 0.0, 0.0}).back());
  EXPECT_NEAR(pushed[0], 2.0 / 400.0, 0.05 / 400.0 + 1e-5) << "friction holds 0.01 N·m / 0.215 m of it";
  EXPECT_NEAR(pushed[1], 0.0, 0.05 / 400.0);
}

TEST(SimulatedPremium, SwingsBackToItsHandAsAMassOnASpringAndADamper) {
  const auto device = open_device("sim:premium?path=0:0:0mm&encoder=off&gravity=off&friction=off");
  const double from = tip(samples(*device, 3000, {1.0 * 0.215, 0.0, 0.0}).back())[0];
  EXPECT_NEAR(from, 1.0 / 500.0, 1e-6);
  (void)device->write({});
  const double mass = Premium({.payload_kg = 0.15}).inertia(Vector::Zero())(0, 0) / (0.215 * 0.215);
  const double decay = 5.0 / (2.0 * mass);
  const double frequency = std::sqrt(500.0 / mass - decay * decay);
  for (int tick = 3000; tick < 3500; ++tick) {
    Sample sample;
    (void)device->read(tick * period_s, sample);
    const double t = (tick - 2999) * period_s;
    const double swing = std::cos(frequency * t) + decay / frequency * std::sin(frequency * t);
    ASSERT_NEAR(tip(sample)[0], from * std::exp(-decay * t) * swing, 0.01 * from);
  }
}

TEST(SimulatedPremium, StaysWithinItsStops) {
  for (const Axes& torque :
       {Axes{1.0, 1.0, 1.0}, Axes{-1.0, -1.0, -1.0}, Axes{0.0, 1.0, -1.0}, Axes{0.0, -1.0, 1.0}}) {
    const auto device = open_device(bare);
    for (const Sample& sample : samples(*device, 500, torque)) {
      const Vector q = angles(sample);
      ASSERT_TRUE(Premium::within_limits(q) || Premium::within_limits(q * (1.0 - 1e-9))) << q.transpose();
    }
  }
}

TEST(SimulatedPremium, FeelsTissueAtItsJoints) {
  Surroundings around;
  around.tissue[1] = [](double angle, double, double) { return -2.0 * angle; };
  const auto device = open_device("sim:premium?hand=off&encoder=off&noise=off", std::move(around));
  const Sample rest = samples(*device, 3000, {0.0, 0.2, 0.0}).back();
  const double weight = Premium().gravity(angles(rest))[1];
  EXPECT_NEAR(rest.position[1], (0.2 - weight) / 2.0, 0.01 / 2.0) << "but for friction";
  EXPECT_NEAR(rest.force_measured[1], -2.0 * rest.position[1], 1e-12);
}

TEST(SimulatedPremium, IsTheSameBitForBitWithOneSeed) {
  const auto first = samples(*open_device("sim:premium?seed=5"), 3000);
  const auto again = samples(*open_device("sim:premium?seed=5"), 3000);
  const auto other = samples(*open_device("sim:premium?seed=6"), 3000);
  bool differs = false;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(first[i].position[axis]),
                std::bit_cast<std::uint64_t>(again[i].position[axis]));
      ASSERT_EQ(first[i].velocity[axis], again[i].velocity[axis]);
      ASSERT_EQ(first[i].force_measured[axis], again[i].force_measured[axis]);
      differs = differs || first[i].position[axis] != other[i].position[axis];
    }
  }
  EXPECT_TRUE(differs);
}

TEST(SimulatedPremium, MovesTheSameHoweverOftenItIsRead) {
  const auto often = open_device("sim:premium?encoder=off");
  const auto seldom = open_device("sim:premium?encoder=off");
  Sample sample;
  (void)seldom->read(1.0, sample);
  EXPECT_EQ(samples(*often, 1001).back().position, sample.position);
}

TEST(SimulatedPremium, GivesTheTruthBesideItsTip) {
  const auto device = open_device("sim:premium?truth=on");
  ASSERT_EQ(device->info().channels.size(), 9U);
  EXPECT_EQ(device->info().channels[3].name, "q1_true");
  for (const Sample& sample : samples(*device, 2000)) {
    for (std::size_t at = 0; at < 3; ++at) {
      const double step = device->info().axes[at].resolution;
      ASSERT_LE(std::abs(sample.position[at] - sample.channels[3 + at]), 0.5001 * step);
    }
    ASSERT_LT((tip(sample) - Premium::tip(angles(sample))).norm(), 1e-16);
  }
}

TEST(SimulatedPremium, LimitsTheTorqueOfItsMotors) {
  const Axes limit{0.129 * 13.3, 0.129 * 11.2, 0.129 * 11.2};
  EXPECT_EQ(samples(*open_device("sim:premium?encoder=off"), 300, {1e6, 1e6, 1e6}).back().position,
            samples(*open_device("sim:premium?encoder=off"), 300, limit).back().position);
}

TEST(SimulatedPremium, TakesNoTorqueThatIsNotFiniteAndNoneAfterARelease) {
  const auto device = open_device("sim:premium?path=0:0:0mm&encoder=off&gravity=off");
  Sample sample;
  EXPECT_EQ(device->write({std::numeric_limits<double>::quiet_NaN()}), Status::fault);
  EXPECT_EQ(device->write({0.5}), Status::ok);
  device->release(0.0);
  (void)device->read(0.5, sample);
  EXPECT_LT(angles(sample).norm(), 1e-15);
}

TEST(SimulatedPremium, RefusesWhatItCannotDo) {
  EXPECT_THAT(refusal("sim:premium?swing=3deg"),
              AllOf(HasSubstr("no option 'swing'"), HasSubstr("path, reach")));
  EXPECT_THAT(refusal("sim:premium?path=0:0:500mm"),
              AllOf(HasSubstr("cannot be at 0:0:500mm"), HasSubstr("40 mm")));
  EXPECT_THAT(refusal("sim:premium?path=0:0:0"), HasSubstr("expected X:Y:Z"));
  EXPECT_THAT(refusal("sim:premium?path="), HasSubstr("expected X:Y:Z"));
  EXPECT_THAT(refusal("sim:premium?payload=-1kg"), HasSubstr("unit kg"));
}

TEST(SimulatedPremium, ReachesEverythingWithinTheLargestReach) {
  for (const double x : {-0.06, 0.06}) {
    for (const double y : {-0.06, 0.06}) {
      for (const double z : {-0.06, 0.06})
        EXPECT_TRUE(Premium::joint_angles({x, y, z})) << x << " " << y << " " << z;
    }
  }
}

TEST(SimulatedPremium, AllocatesNothingInATick) {
  const auto device = open_device("sim:premium");
  Sample sample;
  const std::size_t before = test::allocations();
  for (int tick = 0; tick < 2000; ++tick) {
    (void)device->read(tick * period_s, sample);
    (void)device->write({0.5, 0.1, -0.2});
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace kerf::drivers
