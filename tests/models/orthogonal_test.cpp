#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <kerf/models/orthogonal.h>

namespace kerf::models {
namespace {

using Eigen::Vector3d;
using mechanisms::Premium;

const Premium premium;
const Plane ground{.point = {0.0, 0.01, 0.0}, .normal = Vector3d(0.2, 1.0, -0.1).normalized()};
const Sphere ball{.centre = {0.0, -0.05, 0.0}, .radius_m = 0.08};

struct Draw {
  Vector3d q, qd;
};
std::vector<Draw> draws(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Draw> all;
  while (static_cast<int>(all.size()) < count) {
    const Vector3d q(0.8 * uniform(random), 0.6 * uniform(random), 0.6 * uniform(random));
    if (Premium::within_limits(q))
      all.push_back({q, Vector3d(uniform(random), uniform(random), uniform(random))});
  }
  return all;
}

/// phi'' of the device under a torque and a push of the hand.
template <typename S>
double normal_acceleration(const S& surface, const Draw& at, const Vector3d& torque) {
  const auto device = premium.dynamics(at.q, at.qd);
  const SurfaceContact contact = contact_with(surface, device, at.q, at.qd);
  const Vector3d qdd = premium.acceleration(at.q, at.qd, torque);
  return contact.jacobian.dot(qdd) + contact.jacobian_rate.dot(at.qd);
}

template <typename S>
double worst_normal_error(const S& surface, Projection projection) {
  double worst = 0.0;
  for (const Draw& at : draws(300)) {
    const auto device = premium.dynamics(at.q, at.qd);
    const SurfaceContact contact = contact_with(surface, device, at.q, at.qd);
    const double lambda_d = -1.5;
    const Vector3d torque = orthogonal_torque(contact, device, at.qd, projection, lambda_d, 0.06);
    const double mobility = contact.jacobian * device.inertia.inverse() * contact.jacobian.transpose();
    worst = std::max(worst, std::abs(normal_acceleration(surface, at, torque) + mobility * lambda_d));
  }
  return worst;
}

TEST(Orthogonal, TheConsistentProjectionReachesItsNormalLoopExactly) {
  // phi'' = (J H^-1 J^T)(lambda - lambda_d), whatever the tangent does.
  EXPECT_LE(worst_normal_error(ground, Projection::consistent), 1e-11);
  EXPECT_LE(worst_normal_error(ball, Projection::consistent), 1e-11);
}

TEST(Orthogonal, TheProjectionOfThePaperDoesNot) {
  EXPECT_GT(worst_normal_error(ground, Projection::paper), 0.1);
  EXPECT_GT(worst_normal_error(ball, Projection::paper), 0.1);
}

TEST(Orthogonal, TheTangentOfTheConsistentProjectionFeelsNothingOfTheNormalForce) {
  for (const Draw& at : draws(300)) {
    const auto device = premium.dynamics(at.q, at.qd);
    const SurfaceContact contact = contact_with(ball, device, at.q, at.qd);
    const auto torque = [&](double lambda_d) {
      return orthogonal_torque(contact, device, at.qd, Projection::consistent, lambda_d, 0.06);
    };
    const Vector3d through = device.inertia.inverse() * contact.jacobian.transpose();
    const Vector3d change = device.inertia.inverse() * (torque(1.0) - torque(0.0));
    EXPECT_LE((change + through).norm(), 1e-10 * through.norm()) << "H^-1 J^T alone, which N takes to zero";
  }
}

TEST(Orthogonal, TangentialDampingTakesEnergyAndLeavesTheNormalAlone) {
  for (const Projection projection : {Projection::consistent, Projection::paper}) {
    for (const Draw& at : draws(300)) {
      const auto device = premium.dynamics(at.q, at.qd);
      const SurfaceContact contact = contact_with(ball, device, at.q, at.qd);
      const Vector3d damping = orthogonal_torque(contact, device, at.qd, projection, 0.0, 0.06) -
                               orthogonal_torque(contact, device, at.qd, projection, 0.0, 0.0);
      EXPECT_LE(at.qd.dot(damping), 1e-15);
    }
  }
}

TEST(ImplicitSurface, TheRateOfTheJacobianIsThatOfTheMotion) {
  // Plane and sphere in closed form, and an ellipsoid given by phi and its gradient alone.
  const SurfaceOf ellipsoid{
      [](const Vector3d& p) {
        return p.x() * p.x() / 0.01 + p.y() * p.y() / 0.04 + p.z() * p.z() / 0.02 - 1.0;
      },
      [](const Vector3d& p) { return Vector3d(2.0 * p.x() / 0.01, 2.0 * p.y() / 0.04, 2.0 * p.z() / 0.02); }};
  const auto expect_rate = [&](const auto& surface, double tolerance) {
    for (const Draw& at : draws(50)) {
      const double h = 1e-6;
      const auto jacobian_at = [&](const Vector3d& q) {
        return contact_with(surface, premium.dynamics(q, at.qd), q, at.qd).jacobian;
      };
      const auto difference =
          ((jacobian_at(at.q + h * at.qd) - jacobian_at(at.q - h * at.qd)) / (2.0 * h)).eval();
      const SurfaceContact contact = contact_with(surface, premium.dynamics(at.q, at.qd), at.q, at.qd);
      EXPECT_LE((contact.jacobian_rate - difference).norm(), tolerance * (1.0 + difference.norm()));
    }
  };
  expect_rate(ground, 1e-8);
  expect_rate(ball, 1e-8);
  expect_rate(ellipsoid, 1e-6);
}

Orthogonal made(const std::vector<double>& values, const Options& options) {
  return Orthogonal::make(values, options);
}

TEST(Orthogonal, PressesOutOfThePlaneWithTheForceOfItsLaw) {
  // In vivo intestine of [Sepulveda2008] under a horizontal plane at the origin, device at rest: J_tip^-T tau
  // is the force.
  const Orthogonal law = made({4.3e-7, 13.0, 20.0, 0.06}, {{"point", std::string("0 0.1 0")}});
  Orthogonal::State state;
  const Vector3d q(0.1, 0.05, -0.05);
  const AxisValues torque = law.step(state, {{q[0], q[1], q[2]}, {}}, 1e-3);
  const auto device = premium.dynamics(q, Vector3d::Zero());
  const Vector3d force =
      device.jacobian.transpose().inverse() * (Vector3d(torque[0], torque[1], torque[2]) - device.gravity);
  const double depth = 0.1 - device.tip.y();
  EXPECT_NEAR(force.y() / (4.3e-7 * std::exp(13.0 * depth / 0.1)), 1.0, 1e-9);
  EXPECT_NEAR(force.x(), 0.0, 1e-12);
  EXPECT_NEAR(force.z(), 0.0, 1e-12);
}

TEST(Orthogonal, OutsideTheObjectItOnlyCarriesTheDevice) {
  Orthogonal::State state;
  const SpatialMotion motion{{0.1, 0.3, -0.2}, {0.5, -1.0, 0.7}};
  const Orthogonal law = made({0.1, 5.0, 2.0, 0.06}, {{"point", std::string("0 -1 0")}});
  const Vector3d q(0.1, 0.3, -0.2);
  const Vector3d qd(0.5, -1.0, 0.7);
  const AxisValues torque = law.step(state, motion, 1e-3);
  const Vector3d weight = premium.coriolis(q, qd) * qd + premium.gravity(q);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(torque[static_cast<std::size_t>(i)], weight[i], 1e-14);
  const Orthogonal bare =
      made({0.1, 5.0, 2.0, 0.06}, {{"point", std::string("0 -1 0")}, {"compensate", false}});
  EXPECT_EQ(bare.step(state, motion, 1e-3), AxisValues{});
}

TEST(Orthogonal, ViscosityResistsGoingInAndNotTheGrowthOfACrack) {
  const Vector3d q(0.1, 0.05, -0.05);
  const auto device = premium.dynamics(q, Vector3d::Zero());
  // Straight down at 50 mm/s, 0.1 m under the plane.
  const Vector3d qd = device.jacobian.inverse() * Vector3d(0.0, -0.05, 0.0);
  const SpatialMotion motion{{q[0], q[1], q[2]}, {qd[0], qd[1], qd[2]}};
  const std::string surface = std::to_string(device.tip.y() + 0.1);
  const Orthogonal deforming = made({4.3e-7, 13.0, 20.0, 0.0}, {{"point", "0 " + surface + " 0"}});
  Orthogonal::State state;
  (void)deforming.step(state, motion, 1e-3);
  EXPECT_NEAR(state.normal_force, 0.190237758564 + 20.0 * 0.05, 1e-6);
  const Orthogonal cutting =
      made({4.3e-7, 13.0, 20.0, 0.0, 1e-3, 2000.0, 1e-3},
           {{"point", "0 " + surface + " 0"}, {"interaction", std::string("cutting")}});
  Orthogonal::State cut;
  (void)cutting.step(cut, motion, 1e-3);
  ASSERT_EQ(cut.fracture.mode, Fracture<double>::Mode::fracture);
  EXPECT_EQ(cut.normal_force, 0.0);
  (void)cutting.step(cut, motion, 1e-3);
  ASSERT_EQ(cut.fracture.mode, Fracture<double>::Mode::cutting);
  EXPECT_NEAR(cut.normal_force, 2.0, 1e-12);
}

TEST(Orthogonal, AtTheCentreOfASphereThereIsNoDirectionAndNoFault) {
  const Orthogonal law = made({0.1, 5.0, 2.0, 0.06}, {{"surface", std::string("sphere")}});
  Orthogonal::State state;
  for (const double torque : law.step(state, {{0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}}, 1e-3)) {
    EXPECT_TRUE(std::isfinite(torque));
  }
}

TEST(Orthogonal, RefusesANormalWithoutLengthAndAPointThatIsNone) {
  EXPECT_THROW((void)made({0.1, 5.0, 2.0, 0.06}, {{"normal", std::string("0 0 0")}}), std::invalid_argument);
  EXPECT_NO_THROW((void)made({0.1, 5.0, 2.0, 0.06}, {{"normal", std::string("0 1e200 0")}}));
  EXPECT_THROW((void)made({0.1, 5.0, 2.0, 0.06}, {{"point", std::string("0 0")}}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::models
