#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <kerf/models/blade.h>
#include <kerf/models/law.h>

namespace kerf::models {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A rectangle: 10 mm along x, 30 mm along z, tip 12 mm under, hand at z = 0.10 m.
const BladeShape rectangle =
    BladeShape::parse("-0.005 0 -0.112, 0.005 0 -0.112, 0.005 0 -0.082, -0.005 0 -0.082", "");
const BladeField friction{.edge = 0.0, .normal = 2e4, .tangential = 4e3};
const Pose upright{.hand = {0.0, 0.0, 0.10}};
constexpr auto exact = BladeFidelity::Kind::exact;
constexpr auto strips = BladeFidelity::Kind::strips;
constexpr auto paper = BladeFidelity::Kind::paper;

Vector6d wrench_of(const BladeShape& shape, const BladeField& field, const BladeFidelity& fidelity,
                   const Pose& pose, const Twist& twist) {
  const Wrench wrench = blade_wrench(shape, field, fidelity, pose, twist);
  Vector6d both;
  both << wrench.force, wrench.moment;
  return both;
}
void expect_near(const Vector6d& got, const Vector6d& expected, double tolerance) {
  EXPECT_LE((got - expected).cwiseAbs().maxCoeff(), tolerance)
      << "got " << got.transpose() << "\nexpected " << expected.transpose();
}

const Twist t1{.linear = {0.05, 0.02, 0.0}};
const Twist t2{.angular = {0.0, 0.0, 2.0}};

TEST(Blade, MeetsTheCheckValues) {
  expect_near(wrench_of(rectangle, friction, {exact}, upright, t1),
              (Vector6d() << -0.024, -0.048, 0.0, -5.088e-3, 2.544e-3, 0.0).finished(), 1e-10 * 0.05);
  expect_near(wrench_of(rectangle, friction, {exact}, upright, t2),
              (Vector6d() << 0.0, 0.0, 0.0, 0.0, 0.0, -4.0e-5).finished(), 1e-10 * 4e-5);
}

TEST(Blade, TheModelOfThePaperMissesTheTorqueAboutItsAxis) {
  expect_near(wrench_of(rectangle, friction, {paper, 16}, upright, t2), Vector6d::Zero(), 0.0);
  EXPECT_NEAR(wrench_of(rectangle, friction, {strips, 16}, upright, t2)[5] / -4.0e-5, 1.0, 0.01);
  expect_near(wrench_of(rectangle, friction, {paper, 16}, upright, t1),
              wrench_of(rectangle, friction, {exact}, upright, t1), 1e-15);
}

TEST(Blade, ForceOpposesVelocityAndIsHarderAcrossTheBladeThanAlongIt) {
  const auto along = wrench_of(rectangle, friction, {exact}, upright, {.linear = {0.05, 0.0, 0.0}});
  const auto across = wrench_of(rectangle, friction, {exact}, upright, {.linear = {0.0, 0.05, 0.0}});
  EXPECT_NEAR(across[1] / along[0], friction.normal / friction.tangential, 1e-12);
}

Twist random_twist(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return {.linear = 0.1 * Vector3d(normal(random), normal(random), normal(random)),
          .angular = Vector3d(normal(random), normal(random), normal(random))};
}
Pose random_pose(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Matrix3d turn = rotation_of(0.7 * Vector3d(normal(random), normal(random), normal(random)));
  // The middle of the blade near the surface, so that most poses cut it.
  return {.hand = Vector3d(0.0, 0.0, 0.01 * normal(random)) - turn * Vector3d(0.0, 0.0, -0.097),
          .rotation = turn};
}

/// What one point of the blade adds, per length or area, in the frame of the tissue.
Vector6d density(const Vector3d& point, const Matrix3d& k, const Pose& pose, const Twist& twist) {
  const Vector3d arm = point - pose.hand;
  const Vector3d force = -k * (twist.linear + twist.angular.cross(arm));
  Vector6d both;
  both << force, arm.cross(force);
  return both;
}

/// Adaptive Simpson of a vector, by bisection to 1e-13 of its size.
Vector6d adaptive(const std::function<Vector6d(double)>& f, double a, double b, const Vector6d& fa,
                  const Vector6d& fm, const Vector6d& fb, double scale, int depth) {
  const double m = 0.5 * (a + b);
  const Vector6d left = f(0.5 * (a + m));
  const Vector6d right = f(0.5 * (m + b));
  const Vector6d coarse = (b - a) / 6.0 * (fa + 4.0 * fm + fb);
  const Vector6d fine = (b - a) / 12.0 * (fa + 4.0 * left + 2.0 * fm + 4.0 * right + fb);
  if (depth == 0 || (fine - coarse).cwiseAbs().maxCoeff() <= 1e-13 * scale)
    return fine + (fine - coarse) / 15.0;
  return adaptive(f, a, m, fa, left, fm, scale, depth - 1) +
         adaptive(f, m, b, fm, right, fb, scale, depth - 1);
}

/// The surface integral as an iterated one: over lines of the polygon, and adaptively across them.
Vector6d by_quadrature(const BladeShape& shape, const BladeField& field, const Pose& pose, const Twist& twist,
                       double scale) {
  Vector6d sum = Vector6d::Zero();
  for (std::size_t p = 0; p < shape.polygons; ++p) {
    const BladeShape::Polygon& polygon = shape.polygon[p];
    const Vector3d n = pose.rotation * polygon.normal;
    const Matrix3d k =
        field.tangential * Matrix3d::Identity() + (field.normal - field.tangential) * n * n.transpose();
    const Vector3d e1 = polygon.across;
    const Vector3d e2 = polygon.normal.cross(e1);
    // The inner integral bends at the corners and where a side meets the plane.
    std::vector<double> bends;
    for (std::size_t i = 0; i < polygon.corners; ++i) {
      const Vector3d& corner = polygon.corner[i];
      const Vector3d& next = polygon.corner[(i + 1) % polygon.corners];
      bends.push_back(e1.dot(corner));
      const double z = (pose.hand + pose.rotation * corner).z();
      const double next_z = (pose.hand + pose.rotation * next).z();
      if (z * next_z < 0.0) bends.push_back(e1.dot(corner + z / (z - next_z) * (next - corner)));
    }
    std::sort(bends.begin(), bends.end());
    const auto line = [&](double s) -> Vector6d {
      double low = -1e9;
      double high = 1e9;
      const Vector3d base = polygon.corner[0] + (s - e1.dot(polygon.corner[0])) * e1;
      const auto keep = [&](double constant, double slope) {  // constant + slope t >= 0
        if (slope > 0.0) low = std::max(low, -constant / slope);
        if (slope < 0.0) high = std::min(high, -constant / slope);
        if (slope == 0.0 && constant < 0.0) high = low - 1.0;
      };
      for (std::size_t i = 0; i < polygon.corners; ++i) {
        const Vector3d inward =
            polygon.normal.cross(polygon.corner[(i + 1) % polygon.corners] - polygon.corner[i]);
        keep(inward.dot(base - polygon.corner[i]), inward.dot(e2));
      }
      keep(-(pose.hand + pose.rotation * base).z(), -(pose.rotation * e2).z());
      Vector6d inner = Vector6d::Zero();
      if (!(low < high)) return inner;
      // Three Gauss points: the density is of second degree in a coordinate.
      for (const auto& [place, weight] :
           {std::pair{-std::sqrt(0.6), 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {std::sqrt(0.6), 5.0 / 9.0}}) {
        const double t = 0.5 * (low + high) + 0.5 * (high - low) * place;
        inner += 0.5 * (high - low) * weight *
                 density(pose.hand + pose.rotation * (base + t * e2), k, pose, twist);
      }
      return inner;
    };
    for (std::size_t i = 1; i < bends.size(); ++i) {
      const double from = bends[i - 1] + 1e-15;
      const double to = bends[i] - 1e-15;
      if (from < to)
        sum += adaptive(line, from, to, line(from), line(0.5 * (from + to)), line(to), scale, 40);
    }
  }
  if (shape.has_edge) {
    Vector3d a = pose.hand + pose.rotation * shape.edge[0];
    Vector3d b = pose.hand + pose.rotation * shape.edge[1];
    if (a.z() > b.z()) std::swap(a, b);
    if (a.z() < 0.0) {
      if (b.z() > 0.0) b = a + a.z() / (a.z() - b.z()) * (b - a);
      const Matrix3d k = field.edge * Matrix3d::Identity();
      sum += (b - a).norm() / 6.0 *
             (density(a, k, pose, twist) + 4.0 * density(0.5 * (a + b), k, pose, twist) +
              density(b, k, pose, twist));
    }
  }
  return sum;
}

const BladeShape scalpel = BladeShape::parse(
    "-0.001 0 -0.112, 0.004 0.0005 -0.105, 0.004 0.0005 -0.082, -0.004 -0.0003 -0.082;"
    "-0.001 0 -0.112, 0.004 -0.0005 -0.105, 0.004 -0.0005 -0.082;"
    "0.004 -0.0005 -0.105, 0.004 0.0005 -0.105, 0.004 0.0005 -0.082, 0.004 -0.0005 -0.082",
    "-0.001 0 -0.112, 0.004 0 -0.082");

TEST(Blade, ExactAgreesWithAdaptiveQuadratureAtAThousandPoses) {
  std::mt19937_64 random(7);
  const BladeField field{.edge = 5.0, .normal = 2e4, .tangential = 4e3};
  const BladeShape shape = BladeShape::parse(
      "-0.005 0.001 -0.112, 0.005 0.001 -0.112, 0.007 0.001 -0.09, 0.005 0.001 -0.082, -0.005 0.001 -0.082;"
      "-0.005 -0.001 -0.112, 0.005 -0.001 -0.112, 0.005 -0.001 -0.082",
      "0.005 0 -0.112, 0.005 0 -0.082");
  int submerged = 0;
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = random_pose(random);
    const Twist twist = random_twist(random);
    const Vector6d got = wrench_of(shape, field, {exact}, pose, twist);
    const double scale = got.cwiseAbs().maxCoeff();
    if (scale == 0.0) continue;
    ++submerged;
    expect_near(got, by_quadrature(shape, field, pose, twist, scale), 1e-9 * scale);
  }
  EXPECT_GT(submerged, 700);
}

TEST(Blade, AnEdgeThatOnlyGrazesThePlaneIsContinuous) {
  const BladeField field{.edge = 5.0, .normal = 2e4, .tangential = 4e3};
  for (const double angle : {0.0, 1e-12, 1e-8, 1e-4, 0.3}) {
    const Matrix3d turn = rotation_of({0.0, angle, 0.0});
    for (const double depth : {0.0, 1e-18, 1e-15, 1e-12, 1e-9}) {
      // The lowest corner is `depth` under the surface.
      double lowest = 1e9;
      for (std::size_t i = 0; i < 4; ++i)
        lowest = std::min(lowest, (turn * rectangle.polygon[0].corner[i]).z());
      const Pose pose{.hand = {0.0, 0.0, -lowest - depth}, .rotation = turn};
      const Vector6d got = wrench_of(rectangle, field, {exact}, pose, t1);
      ASSERT_TRUE(got.allFinite());
      EXPECT_LE(got.cwiseAbs().maxCoeff(), 2e4 * 0.06 * 0.0101 * (depth + 1e-15) + 1e-16)
          << angle << ' ' << depth;
      expect_near(got, by_quadrature(rectangle, field, pose, t1, 1.0), 1e-13);
    }
  }
}

TEST(Blade, DoesNotDependOnWhereThePolygonBeginsOrWhichWayItTurns) {
  const auto turned =
      BladeShape::parse("-0.005 0 -0.082, 0.005 0 -0.082, 0.005 0 -0.112, -0.005 0 -0.112", "");
  std::mt19937_64 random(3);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random_pose(random);
    const Twist twist = random_twist(random);
    expect_near(wrench_of(turned, friction, {exact}, pose, twist),
                wrench_of(rectangle, friction, {exact}, pose, twist), 1e-12);
  }
}

TEST(Blade, StripsConvergeToTheExactForce) {
  // The force; the torque misses d^3/12 of a strip where the blade turns about an axis across it.
  std::mt19937_64 random(5);
  for (int i = 0; i < 50; ++i) {
    const Pose pose = random_pose(random);
    const Twist twist = random_twist(random);
    const Vector3d all = wrench_of(rectangle, friction, {exact}, pose, twist).head<3>();
    const auto error = [&](std::size_t n) {
      return (wrench_of(rectangle, friction, {strips, n}, pose, twist).head<3>() - all).norm();
    };
    EXPECT_LE(error(256), 1e-3 * all.norm() + 1e-9);
    EXPECT_LE(error(16), 0.03 * all.norm() + 1e-6);
  }
}

TEST(Blade, ARotationAcrossTheStripsHasATorqueThatNoNumberOfStripsFinds) {
  const Twist about_x{.linear = {0.0, -0.106, 0.0},
                      .angular = {1.0, 0.0, 0.0}};  // about the middle of what is under
  const double all = wrench_of(rectangle, friction, {exact}, upright, about_x)[3];
  const double closed_form = -2e4 * 0.01 * std::pow(0.012, 3) / 12.0;
  EXPECT_NEAR(all, closed_form, 1e-12);
  EXPECT_NEAR(wrench_of(rectangle, friction, {strips, 256}, upright, about_x)[3], 0.0, 1e-12);
}

TEST(Blade, NeverGivesPower) {
  std::mt19937_64 random(11);
  const BladeField field{.edge = 5.0, .normal = 2e4, .tangential = 4e3};
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = random_pose(random);
    const Twist twist = random_twist(random);
    const Vector6d wrench = wrench_of(scalpel, field, {exact}, pose, twist);
    EXPECT_LE(wrench.head<3>().dot(twist.linear) + wrench.tail<3>().dot(twist.angular), 1e-15);
  }
}

Blade with_thresholds(double release, double rupture, const Options& options = {}) {
  return Blade::make(std::vector{5.0, 2e4, 4e3, 500.0, 1e6, 3e5, release, rupture}, options);
}

TEST(Blade, HoldsElasticallyUntilF1AndCutsUntilF0) {
  const Blade blade = with_thresholds(0.01, 0.05);
  Blade::State state;
  double y = 0.0;
  int held = 0;
  while (!state.mode.cutting && ++held < 100000) {
    y += 1e-6;
    const Wrench wrench = blade.step(state, {.hand = {0.0, y, 0.10}}, {.linear = {0.0, 1e-3, 0.0}});
    // Elastic while it holds: stiffness times displacement of the submerged part, 10 x 12 mm, and the edge.
    if (!state.mode.cutting) {
      ASSERT_NEAR(wrench.force.y(), -(1e6 * 0.01 * 0.012 + 500.0 * 0.012) * (y - 1e-6), 1e-9);
    }
  }
  EXPECT_EQ(state.mode.transitions, 1U);
  const Wrench cutting = blade.step(state, {.hand = {0.0, y, 0.10}}, {.linear = {0.0, 0.02, 0.0}});
  EXPECT_NEAR(cutting.force.y(), -(2e4 * 0.01 * 0.012 + 5.0 * 0.012) * 0.02, 1e-12);
  (void)blade.step(state, {.hand = {0.0, y, 0.10}}, {.linear = {0.0, 1e-6, 0.0}});
  EXPECT_FALSE(state.mode.cutting);
  EXPECT_EQ(state.mode.transitions, 2U);
}

TEST(Blade, HoldsAgainFromWhereItCameToRest) {
  const Blade blade = with_thresholds(0.01, 0.05);
  Blade::State state;
  const auto at = [&](double y, double speed) {
    return blade.step(state, {.hand = {0.0, y, 0.10}}, {.linear = {0.0, speed, 0.0}}).force.y();
  };
  double y = 0.0;
  while (!state.mode.cutting) at(y += 1e-5, 0.02);
  at(y += 0.01, 0.02);
  at(y, 0.0);
  ASSERT_FALSE(state.mode.cutting);
  EXPECT_NEAR(at(y + 1e-5, 1e-3), -(1e6 * 0.01 * 0.012 + 500.0 * 0.012) * 1e-5, 1e-12);
}

TEST(Blade, DilutesItsStrainByWhatComesToBeSubmerged) {
  // 12 mm deep, 0.1 mm along y, then twice as deep and back: the wetted area doubles and halves.
  const double held_n = (1e6 * 0.01 * 0.012 + 500.0 * 0.012) * 1e-4;
  for (const std::string form : {"passive", "paper"}) {
    const Blade blade = with_thresholds(1e3, 2e3, {{"form", form}});
    const bool passive = form == "passive";
    Blade::State state;
    const auto lateral_at = [&](double y, double z) {
      return blade.step(state, {.hand = {0.0, y, z}}, {}).force.y();
    };
    (void)lateral_at(0.0, 0.10);
    EXPECT_NEAR(lateral_at(1e-4, 0.10), -held_n, 1e-15) << form;
    EXPECT_NEAR(lateral_at(1e-4, 0.088), -held_n * (passive ? 1.0 : 2.0), 1e-12) << form;
    EXPECT_NEAR(lateral_at(1e-4, 0.10), -held_n * (passive ? 0.5 : 1.0), 1e-12) << form;
  }
}

TEST(Blade, HoldsTheSameAtAnyPeriod) {
  const Blade blade = with_thresholds(1e3, 2e3);
  const auto force_after = [&](int ticks) {  // along y and into the tissue at once, turning, then half out
    Blade::State state;
    Wrench wrench;
    for (int tick = 0; tick <= ticks; ++tick) {
      const double t = static_cast<double>(tick) / ticks;
      wrench = blade.step(state,
                          {.hand = {0.0, 1e-3 * t, 0.10 - 0.02 * std::sin(2.5 * t)},
                           .rotation = rotation_of({0.1 * t, 0.0, 0.1 * t * t})},
                          {});
    }
    return wrench.force;
  };
  const Vector3d fine = force_after(10000);
  EXPECT_GT(fine.norm(), 0.1);
  EXPECT_LT((force_after(1000) - fine).norm(), 2e-3 * fine.norm());
  EXPECT_LT((force_after(100) - fine).norm(), 2e-2 * fine.norm());
}

TEST(Blade, HoldsWithTheStrainTurnedAlong) {
  const Blade blade = with_thresholds(1e3, 2e3, {{"edge", std::string()}});  // even about its main axis
  Blade::State state;
  (void)blade.step(state, upright, {});
  const Wrench before = blade.step(state, {.hand = {0.0, 1e-4, 0.10}}, {});
  const double held_j = blade.stored_energy(state);
  const Matrix3d turn = rotation_of({0.0, 0.0, 0.3});
  const Wrench after = blade.step(state, {.hand = {0.0, 1e-4, 0.10}, .rotation = turn}, {});
  EXPECT_NEAR((after.force - turn * before.force).norm(), 0.0, 1e-9 * before.force.norm());
  EXPECT_GT(blade.stored_energy(state), held_j) << "by the turn itself";
}

TEST(TwoThresholds, NoiseBelowTheGapNeverMakesThemChatter) {
  const TwoThresholds machine{.release_n = 0.4, .rupture_n = 0.6};
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> noise(-0.0999, 0.0999);
    TwoThresholds::State state;
    for (int tick = 0; tick < 2000; ++tick) {  // up through both thresholds, and down again
      const double force = tick < 1000 ? 1e-3 * tick : 2.0 - 1e-3 * tick;
      (void)machine.step(state, force + noise(random));
    }
    ASSERT_EQ(state.transitions, 2U) << seed;
  }
}

TEST(TwoThresholds, EqualThresholdsChatter) {
  const TwoThresholds machine{.release_n = 0.5, .rupture_n = 0.5};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> noise(-0.1, 0.1);
  TwoThresholds::State state;
  for (int tick = 0; tick < 1000; ++tick) (void)machine.step(state, 1e-3 * tick + noise(random));
  EXPECT_GT(state.transitions, 20U);
}

TEST(Blade, ForceTimesVelocityOfTheAxesIsThePowerOfTheWrench) {
  const Blade blade = Blade::make(std::vector{5.0, 2e4, 4e3}, {{"thresholds", false}});
  const SpatialMotion motion{{0.001, 0.002, 0.09, 0.1, -0.2, 0.4}, {0.05, 0.02, -0.01, 1.0, -2.0, 0.5}};
  Blade::State state;
  const AxisValues force = blade.step(state, motion, 1e-3);
  double power = 0.0;
  for (std::size_t axis = 0; axis < 6; ++axis) power += force[axis] * motion.velocity[axis];
  const Vector3d turn(0.1, -0.2, 0.4);
  const Twist twist{.linear = {0.05, 0.02, -0.01}, .angular = left_jacobian(turn) * Vector3d(1.0, -2.0, 0.5)};
  const Wrench wrench = blade_wrench(blade.shape, blade.viscous, {},
                                     {.hand = {0.001, 0.002, 0.09}, .rotation = rotation_of(turn)}, twist);
  EXPECT_NEAR(power, wrench.force.dot(twist.linear) + wrench.moment.dot(twist.angular), 1e-15);
  EXPECT_LT(power, 0.0);
}

TEST(Rotation, TheLeftJacobianTurnsRatesIntoAngularVelocity) {
  const Vector3d r(0.4, -1.1, 0.7);
  const Vector3d rate(0.3, 0.2, -0.5);
  const double h = 1e-6;
  const Matrix3d change = (rotation_of(r + h * rate) - rotation_of(r - h * rate)) / (2.0 * h);
  const Matrix3d spin = change * rotation_of(r).transpose();
  const Vector3d w = left_jacobian(r) * rate;
  EXPECT_NEAR(spin(2, 1), w.x(), 1e-9);
  EXPECT_NEAR(spin(0, 2), w.y(), 1e-9);
  EXPECT_NEAR(spin(1, 0), w.z(), 1e-9);
  EXPECT_LE((rotation_vector_of(rotation_of(r)) - r).norm(), 1e-14);
  for (const double small : {1e-3, 0.00999, 0.01001}) {
    const Vector3d tiny(small, 0.0, 0.0);
    EXPECT_NEAR(rotation_of(tiny)(2, 1), std::sin(small), 1e-15);
    EXPECT_NEAR(left_jacobian(tiny)(2, 1), (1.0 - std::cos(small)) / small, 1e-13);
  }
}

TEST(BladeShape, RefusesWhatIsNoConvexPlanarPolygon) {
  for (const char* bad :
       {"0 0 0, 1 0 0", "0 0 0, 1 0 0, 1 1 0.1, 0 1 0", "0 0 0, 1 0 0, 0.2 0.2 0, 0 1 0",
        "0 0 0, 1 0 0, 2 0 0", "1 0 0, -0.809 0.588 0, 0.309 -0.951 0, 0.309 0.951 0, -0.809 -0.588 0",
        "0 0 0, 1 0, 1 1 0", "0 0 0, 1 0 0, 1 1 zero"}) {
    EXPECT_THROW((void)BladeShape::parse(bad, ""), std::invalid_argument) << bad;
  }
  EXPECT_THROW((void)BladeShape::parse("", ""), std::invalid_argument);
  EXPECT_THROW((void)BladeShape::parse("", "0 0 0"), std::invalid_argument);
  EXPECT_NO_THROW((void)BladeShape::parse("", "0 0 0, 0 0 1"));
}

}  // namespace
}  // namespace kerf::models
