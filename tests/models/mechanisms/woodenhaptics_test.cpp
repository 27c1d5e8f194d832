#include "kerf/mechanisms/woodenhaptics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::mechanisms {
namespace {

using Eigen::Vector3d;

// With the signs of the CHAI3D driver, as the documented checks have them.
const WoodenHaptics arm(*WoodenHaptics::find("woody-2016"),
                        {.encoder = {-1.0, -1.0, -1.0}, .motor = {1.0, -1.0, -1.0}});
const WoodenHaptics polhem(*WoodenHaptics::find("polhem-v3"), {});

TEST(WoodenHaptics, StandsAtItsMakersPlaceAtZeroCounts) {
  EXPECT_LE((arm.tip(arm.angles({0, 0, 0})) - Vector3d(0.025, 0.0, 0.205)).norm(), 1e-15);
}

TEST(WoodenHaptics, NeedsTheCurrentsOfTheDocumentedCheckForOneNewton) {
  const Vector3d zero = arm.angles({0, 0, 0});
  const auto expect = [&](const Vector3d& force, const Vector3d& ampere) {
    const auto currents = arm.currents(force, zero).ampere;
    EXPECT_LE((Vector3d(currents[0], currents[1], currents[2]) - ampere).norm(), 6e-4) << force.transpose();
  };
  expect(Vector3d::UnitX(), {0.0, -0.660, 0.0});
  expect(Vector3d::UnitY(), {0.591, 0.0, 0.0});
  expect(Vector3d::UnitZ(), {0.0, 0.0, -0.788});
}

TEST(WoodenHaptics, MovesByTheDocumentedStepPerCount) {
  const Vector3d zero = arm.tip(arm.angles({0, 0, 0}));
  const auto step = [&](std::array<int, 3> counts) { return (arm.tip(arm.angles(counts)) - zero).norm(); };
  EXPECT_NEAR(step({1, 0, 0}), 0.048e-3, 5e-7);
  EXPECT_NEAR(step({0, 1, 0}), 0.054e-3, 5e-7);
  EXPECT_NEAR(step({0, 0, 1}), 0.064e-3, 5e-7);
}

TEST(WoodenHaptics, TheJacobianIsThatOfTheTipForEveryModel) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const auto& configuration : WoodenHaptics::configurations()) {
    const WoodenHaptics device(configuration, {});
    const Vector3d middle = *device.angles_of(configuration.centre_m);
    for (int i = 0; i < 100; ++i) {
      const double a = uniform(random);
      const double b = 0.4 * uniform(random);
      const Vector3d angles = middle + Vector3d(a, b, 0.4 * uniform(random));
      const double h = 1e-6;
      Eigen::Matrix3d difference;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Vector3d step = h * Vector3d::Unit(k);
        difference.col(k) = (device.tip(angles + step) - device.tip(angles - step)) / (2.0 * h);
      }
      EXPECT_LE((device.jacobian(angles) - difference).norm(), 1e-9) << configuration.name;
    }
  }
}

TEST(WoodenHaptics, FindsTheAnglesAndCountsOfAPlaceThatTheTipCanReach) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-0.04, 0.04);  // no model reaches all of 0.1 m around
  for (const auto& configuration : WoodenHaptics::configurations()) {
    const WoodenHaptics device(configuration, {});
    const Vector3d& middle = configuration.centre_m;
    for (int i = 0; i < 200; ++i) {
      const double x = uniform(random);
      const double y = uniform(random);
      const Vector3d place = middle + Vector3d(x, y, uniform(random));
      const auto angles = device.angles_of(place);
      ASSERT_TRUE(angles) << configuration.name;
      EXPECT_LE((device.tip(*angles) - place).norm(), 1e-12) << configuration.name;
      // Rounded to whole counts the tip is off by half a step of each encoder at most.
      std::array<int, 3> whole{};
      const auto counts = device.counts(*angles);
      for (std::size_t k = 0; k < 3; ++k) whole[k] = static_cast<int>(std::lround(counts[k]));
      EXPECT_LE((device.angles(whole) - *angles).cwiseAbs().maxCoeff(), 0.5 * 4.6e-4) << configuration.name;
    }
    EXPECT_FALSE(device.angles_of(middle + Vector3d(1.0, 0.0, 0.0)));
    EXPECT_FALSE(device.angles_of(Vector3d(std::nan(""), 0.0, 0.0)));
  }
}

TEST(WoodenHaptics, MakesTheForceWhoseCurrentsItIsGiven) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const auto& configuration : WoodenHaptics::configurations()) {
    const WoodenHaptics device(configuration, {});
    const Vector3d middle = *device.angles_of(configuration.centre_m);
    for (int i = 0; i < 100; ++i) {
      const double a = 0.3 * uniform(random);
      const double b = 0.3 * uniform(random);
      const Vector3d angles = middle + Vector3d(a, b, 0.3 * uniform(random));
      const double x = uniform(random);
      const double y = uniform(random);
      const Vector3d asked(0.1 * x, 0.1 * y, 0.1 * uniform(random));
      const auto currents = device.currents(asked, angles);
      ASSERT_FALSE(currents.limited);
      EXPECT_LE((device.force(currents.ampere, angles) - asked).norm(), 1e-12) << configuration.name;
    }
  }
  // The other way round from the documented check: 0.591 A in motor A is 1 N along y.
  EXPECT_LE((arm.force({0.591, 0.0, 0.0}, arm.angles({0, 0, 0})) - Vector3d::UnitY()).norm(), 1e-3);
}

// The linkage as its loop, closed by Newton's method in a few lines of Python that know no triangle: unknown
// are the angles lambda of the forearm and mu of the coupler in
//
//     L0/2 + L1 cos B - L4 cos lambda = -L0/2 + L2 cos C + L3 cos mu
//            L1 sin B - L4 sin lambda =         L2 sin C + L3 sin mu
//
// with the lengths of hfabapi, begun at lambda = -0.53, mu = 1.9 rad where the makers park it, and followed
// in 400 steps from there. The tip is (L0/2 + L1 cos B + L5 cos lambda, L1 sin B + L5 sin lambda) in the
// plane that stands at A.
//
//     A [rad]  B [rad]    C [rad]    lambda      x [m]         y [m]        z [m]
//     2.10215  2.1788356  4.1632239  -0.5281817  -0.222597934  0.030792846  0.037008541    parked
//     0        0.9126951  2.3601052  -0.8473754   0            0            0              middle
//     0.3      1.4        3.2        -0.5239934  -0.053275123  0.046779336  0.064654506
//
// The first is also what the makers' own program says of these counters.
TEST(WoodenHaptics, APolhemStandsWhereItsLinkageCloses) {
  EXPECT_LE((polhem.home() - Vector3d(-0.222597934, 0.030792846, 0.037008541)).norm(), 1e-9);
  EXPECT_LE(polhem.tip(Vector3d(0.0, 0.9126951121, 2.3601051956)).norm(), 1e-9);
  EXPECT_LE((polhem.tip(Vector3d(0.3, 1.4, 3.2)) - Vector3d(-0.053275123, 0.046779336, 0.064654506)).norm(),
            1e-9);
}

TEST(WoodenHaptics, APolhemHasNoPlaceWhereItsLinkageCannotClose) {
  // The crank's end would be 0.127 m from the knee; coupler and tail keep them 0.156 m apart at least.
  EXPECT_FALSE(polhem.tip(Vector3d(0.0, 2.1, 0.5 * std::numbers::pi)).allFinite());
  EXPECT_THAT(polhem.currents(Vector3d::UnitX(), Vector3d(0.0, std::nan(""), 2.0)).ampere,
              testing::ElementsAre(0.0, 0.0, 0.0));
}

TEST(WoodenHaptics, CutsAForceWithoutTurningIt) {
  const Vector3d zero = arm.angles({100, -200, 300});
  const auto small = arm.currents(Vector3d(0.1, 0.2, -0.3), zero);
  const auto large = arm.currents(Vector3d(10.0, 20.0, -30.0), zero);
  EXPECT_FALSE(small.limited);
  EXPECT_TRUE(large.limited);
  double most = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    most = std::max(most, std::abs(large.ampere[i]));
    EXPECT_NEAR(large.ampere[i] * small.ampere[0], small.ampere[i] * large.ampere[0], 1e-12);
  }
  EXPECT_DOUBLE_EQ(most, 3.0);
  EXPECT_THAT(arm.currents(Vector3d(std::nan(""), 0.0, 0.0), zero).ampere,
              testing::ElementsAre(0.0, 0.0, 0.0));
}

TEST(WoodenHaptics, KnowsItsModelsByName) {
  EXPECT_EQ(WoodenHaptics::configurations().size(), 4U);
  EXPECT_NE(WoodenHaptics::find("polhem-v3"), nullptr);
  EXPECT_EQ(WoodenHaptics::find("omega"), nullptr);
}

}  // namespace
}  // namespace kerf::mechanisms
