#include "kerf/mechanisms/falcon.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.h"

namespace kerf::mechanisms {
namespace {

using Eigen::Vector3d;
constexpr double degree = std::numbers::pi / 180.0;

/// Places of the knob with arm angles, counts and the motor values for 1 N along x, y and z at 10,000 units
/// per N·m: two derivations that know nothing of each other agree on them.
struct Golden {
  Vector3d knob, degrees;
  std::array<int, 3> counts;
  Vector3d along_x, along_y, along_z;
};
const Golden golden[] = {
    {{0, 0, .075},
     {-18.3195, -18.3195, -18.3195},
     {-1463, -1463, -1463},
     {-87.5, 297.7, -210.2},
     {293.2, -70.8, -222.4},
     {-134.6, -134.6, -134.6}},
    {{0, 0, .10},
     {8.0081, 8.0081, 8.0081},
     {-741, -741, -741},
     {-137.7, 469.5, -331.8},
     {462.6, -112.1, -350.5},
     {-223.9, -223.9, -223.9}},
    {{0, 0, .12},
     {23.9180, 23.9180, 23.9180},
     {-304, -304, -304},
     {-171.1, 580.8, -409.7},
     {571.9, -137.7, -434.1},
     {-251.0, -251.0, -251.0}},
    {{0, 0, .15},
     {47.2433, 47.2433, 47.2433},
     {336, 336, 336},
     {-212.7, 708.6, -495.8},
     {695.3, -163.4, -531.9},
     {-227.7, -227.7, -227.7}},
    {{0, 0, .175},
     {73.4648, 73.4648, 73.4648},
     {1056, 1056, 1056},
     {-216.5, 681.1, -464.6},
     {661.5, -143.2, -518.3},
     {-126.5, -126.5, -126.5}},
    {{.02, 0, .12},
     {29.4654, 12.6723, 34.1295},
     {-152, -613, -24},
     {-174.7, 499.8, -448.8},
     {599.8, -119.4, -487.5},
     {-216.4, -354.2, -164.5}},
    {{-.02, 0, .12},
     {22.1433, 37.3386, 16.6826},
     {-353, 64, -503},
     {-163.6, 660.8, -364.0},
     {556.1, -162.2, -397.0},
     {-283.2, -125.3, -325.0}},
    {{0, .02, .12},
     {12.8668, 28.7457, 34.6484},
     {-607, -172, -10},
     {-152.3, 610.0, -460.5},
     {491.2, -140.5, -474.2},
     {-352.4, -223.1, -159.7}},
    {{.03, -.01, .11},
     {33.1705, -2.5626, 30.1243},
     {-50, -1031, -134},
     {-170.6, 398.3, -422.8},
     {608.7, -88.4, -455.0},
     {-131.9, -390.7, -161.7}},
    {{-.025, .02, .14},
     {28.0780, 57.9128, 42.7212},
     {-190, 629, 212},
     {-191.6, 806.9, -500.3},
     {556.5, -147.9, -468.4},
     {-393.3, -27.6, -265.2}},
};

TEST(Falcon, MeetsTheGoldenVectors) {
  for (const Golden& expected : golden) {
    const auto at = Falcon::angles(expected.knob);
    ASSERT_TRUE(at) << expected.knob.transpose();
    EXPECT_LE((at->shoulder / degree - expected.degrees).cwiseAbs().maxCoeff(), 6e-5);
    EXPECT_EQ(Falcon::counts_of(at->shoulder), expected.counts);
    const auto motor_values = [&](const Vector3d& force) {
      return Vector3d(-1e4 * Falcon::torques(force, *at));
    };
    EXPECT_LE((motor_values(Vector3d::UnitX()) - expected.along_x).cwiseAbs().maxCoeff(), 0.06);
    EXPECT_LE((motor_values(Vector3d::UnitY()) - expected.along_y).cwiseAbs().maxCoeff(), 0.06);
    EXPECT_LE((motor_values(Vector3d::UnitZ()) - expected.along_z).cwiseAbs().maxCoeff(), 0.06);
  }
}

std::vector<Vector3d> workspace(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> side(-0.03, 0.03);
  std::uniform_real_distribution<double> out(0.09, 0.165);
  std::vector<Vector3d> places;
  for (int i = 0; i < count; ++i) {
    const double x = side(random);
    const double y = side(random);
    places.emplace_back(x, y, out(random));
  }
  return places;
}

TEST(Falcon, FindsTheKnobFromItsArms) {
  const Vector3d centre(0.0, 0.0, 0.12);
  for (const Vector3d& place : workspace(1000)) {
    const auto at = Falcon::angles(place);
    ASSERT_TRUE(at);
    const auto found = Falcon::knob(at->shoulder, centre);
    ASSERT_TRUE(found) << place.transpose();
    EXPECT_LE((*found - place).norm(), 1e-11);
  }
}

TEST(Falcon, ItsRatesAreThoseOfItsAngles) {
  for (const Vector3d& place : workspace(200)) {
    const auto at = Falcon::angles(place);
    const double h = 1e-6;
    Eigen::Matrix3d difference;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3d step = h * Vector3d::Unit(k);
      difference.col(k) =
          (Falcon::angles(place + step)->shoulder - Falcon::angles(place - step)->shoulder) / (2.0 * h);
    }
    EXPECT_LE((Falcon::angle_rates(*at) - difference).norm(), 1e-7 * difference.norm());
  }
}

TEST(Falcon, PushesTheWayItIsAskedTo) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (const Vector3d& place : workspace(1000)) {
    const auto at = Falcon::angles(place);
    const double x = normal(random);
    const double y = normal(random);
    const Vector3d asked(x, y, normal(random));
    const Vector3d felt = Falcon::force(Falcon::torques(asked, *at), *at);
    EXPECT_LE((felt - asked).norm(), 1e-12 * asked.norm());
  }
}

TEST(Falcon, SaysWhereTheKnobCannotBe) {
  EXPECT_FALSE(Falcon::angles({0.0, 0.0, 0.19}));
  EXPECT_FALSE(Falcon::angles({0.3, 0.0, 0.12}));
  EXPECT_FALSE(Falcon::angles({std::nan(""), 0.0, 0.12}));
}

TEST(Falcon, AllocatesNothing) {
  const std::size_t before = test::allocations();
  for (int i = 0; i < 100; ++i) {
    const auto knob = Falcon::knob(Falcon::shoulder_of({-300 + i, -310, -290}), {0.0, 0.0, 0.12});
    ASSERT_TRUE(knob);
    (void)Falcon::torques(Vector3d::UnitZ(), *Falcon::angles(*knob));
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace kerf::mechanisms
