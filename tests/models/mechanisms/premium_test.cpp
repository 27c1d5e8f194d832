#include "kerf/mechanisms/premium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "support/allocation_counter.h"

namespace kerf::mechanisms {
namespace {

using Vector = Premium::Vector;
using Matrix = Premium::Matrix;

constexpr double step = 1e-5;  // of central differences, whose error is then about 1e-10
const Premium arm({.payload_kg = 0.05});

struct Motion {
  Vector q;
  Vector qd;
};

/// Poses within the limits and speeds up to 5 rad/s, the same in every run.
class Motions {
 public:
  Motion operator()() {
    Motion motion;
    do {
      for (std::size_t at = 0; at < 3; ++at) {
        const Premium::Range& range = Premium::joint_range_rad[at];
        motion.q[static_cast<int>(at)] = between(range.lower, range.upper);
        motion.qd[static_cast<int>(at)] = between(-5.0, 5.0);
      }
    } while (!Premium::within_limits(motion.q));
    return motion;
  }

 private:
  double between(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  std::mt19937_64 engine_{7};
};

template <typename Check>
void over_the_workspace(Check check) {
  Motions draw;
  for (int i = 0; i < 1000; ++i) check(draw());
}

/// The derivative of a function of the pose as it moves at `qd`.
template <typename Function>
auto rate_of(Function function, const Motion& motion) {
  return ((function(motion.q + step * motion.qd) - function(motion.q - step * motion.qd)) / (2.0 * step))
      .eval();
}

TEST(Premium, HasItsTipAtTheOriginWhenTheUpperArmIsLevelAndTheForearmHangs) {
  EXPECT_LT(Premium::tip(Vector::Zero()).norm(), 1e-16);
  // A right angle each: the arm points up, the forearm outwards.
  const Vector up = Premium::tip({0.0, 0.5 * std::acos(-1.0), 0.5 * std::acos(-1.0)});
  EXPECT_LT((up - Vector(0.0, 0.215 + 0.170, 0.170 - 0.215)).norm(), 1e-15);
}

TEST(Premium, TurnsToTheRightLiftsAndReachesOutWithItsJoints) {
  const Matrix j = Premium::jacobian(Vector::Zero());
  EXPECT_LT((j - Matrix(Vector(0.215, 0.215, 0.170).asDiagonal()).eval()).norm(), 1e-16)
      << "q1 moves x, q2 moves y, q3 moves z";
}

TEST(Premium, HasTheDerivativeOfTheTipAsItsJacobian) {
  over_the_workspace([](const Motion& at) {
    const auto tip = [](const Vector& q) { return Premium::tip(q); };
    ASSERT_LT((Premium::jacobian(at.q) * at.qd - rate_of(tip, at)).norm(), 1e-8);
    const auto jacobian = [](const Vector& q) { return Premium::jacobian(q); };
    ASSERT_LT((Premium::jacobian_rate(at.q, at.qd) - rate_of(jacobian, at)).norm(), 1e-8);
  });
}

TEST(Premium, FindsTheAnglesOfATip) {
  over_the_workspace([](const Motion& at) {
    const auto found = Premium::joint_angles(Premium::tip(at.q));
    ASSERT_TRUE(found.has_value());
    ASSERT_LT((*found - at.q).norm(), 1e-12);
  });
}

TEST(Premium, HasNoAnglesForATipThatItCannotReach) {
  EXPECT_FALSE(Premium::joint_angles({0.0, 0.0, 1.0})) << "too far";
  EXPECT_FALSE(Premium::joint_angles({0.0, 0.17, -0.215})) << "the shoulder";
  EXPECT_FALSE(Premium::joint_angles({0.0, 0.0, -0.5})) << "behind it";
  EXPECT_FALSE(Premium::joint_angles({std::nan(""), 0.0, 0.0}));
  EXPECT_FALSE(Premium::within_limits({0.0, 1.0, -0.5})) << "folded too far";
}

TEST(Premium, HasASymmetricAndPositiveInertia) {
  over_the_workspace([](const Motion& at) {
    const Matrix h = arm.inertia(at.q);
    ASSERT_EQ(h, h.transpose());
    ASSERT_EQ(Eigen::LLT<Matrix>(h).info(), Eigen::Success);
    ASSERT_LT(h.maxCoeff(), 0.02) << "kg·m^2";
  });
}

TEST(Premium, FeelsLikeFortyToEightyGramsAtTheTip) {
  // By hand from the table, in 1e-4 kg·m^2, with the rotors 1.08e-6 x 13.3^2, 11.2^2, 11.2^2 at the end.
  const double about_vertical = 11.87 + 0.0018 + 0.959 + 10.06 + 0.629 + 9.33745 + 2.8775 + 1.9104;
  const double upper_arm = 11.09 + 0.959 + 9.33745 + 2.8775 + 1.3548;
  const double forearm = 7.11 + 0.4864 + 1.45945 + 0.26301 + 1.3548;
  const Vector diagonal = Premium().inertia(Vector::Zero()).diagonal();
  EXPECT_LT((diagonal - 1e-4 * Vector(about_vertical, upper_arm, forearm)).norm(), 1e-8);
  EXPECT_NEAR(diagonal[0] / (0.215 * 0.215), 0.081, 1e-3) << "kg, to the side";
  EXPECT_NEAR(diagonal[1] / (0.215 * 0.215), 0.055, 1e-3) << "upwards";
  EXPECT_NEAR(diagonal[2] / (0.170 * 0.170), 0.037, 1e-3) << "outwards";
}

TEST(Premium, CarriesAPayloadAsAPointAtTheTip) {
  const Premium empty;
  const Matrix at_zero = arm.inertia(Vector::Zero()) - empty.inertia(Vector::Zero());
  EXPECT_LT(
      (at_zero - Matrix((0.05 * Vector(0.215 * 0.215, 0.215 * 0.215, 0.170 * 0.170)).asDiagonal())).norm(),
      1e-16);
  over_the_workspace([&](const Motion& at) {
    const Matrix j = Premium::jacobian(at.q);
    ASSERT_LT((arm.inertia(at.q) - empty.inertia(at.q) - 0.05 * j.transpose() * j).norm(), 1e-16);
    const Vector weight = j.transpose() * Vector(0.0, 0.05 * Premium::gravity_m_s2, 0.0);
    ASSERT_LT((arm.gravity(at.q) - empty.gravity(at.q) - weight).norm(), 1e-15);
    const Vector swing = 0.05 * j.transpose() * (Premium::jacobian_rate(at.q, at.qd) * at.qd);
    const Matrix coriolis = arm.coriolis(at.q, at.qd) - empty.coriolis(at.q, at.qd);
    ASSERT_LT((coriolis * at.qd - swing).norm(), 1e-14);
  });
}

TEST(Premium, HasCoriolisTermsThatDoNoWork) {
  over_the_workspace([](const Motion& at) {
    const auto inertia = [](const Vector& q) { return arm.inertia(q); };
    const Matrix rate = rate_of(inertia, at);
    const Matrix c = arm.coriolis(at.q, at.qd);
    ASSERT_LT((rate - c - c.transpose()).norm(), 1e-9);
    const Vector any = at.q + at.qd;
    ASSERT_LT(std::abs(any.dot((rate - 2.0 * c) * any)), 1e-8);
  });
}

TEST(Premium, HasTheGradientOfItsKineticEnergyInItsCoriolisTerms) {
  // Lagrange: C q' = H' q' - dT/dq, which fixes C q' and not only its power.
  over_the_workspace([](const Motion& at) {
    Vector gradient;
    for (int joint = 0; joint < 3; ++joint) {
      const Vector d = step * Vector::Unit(joint);
      gradient[joint] =
          (arm.kinetic_energy(at.q + d, at.qd) - arm.kinetic_energy(at.q - d, at.qd)) / (2.0 * step);
    }
    const auto momentum = [&](const Vector& q) { return (arm.inertia(q) * at.qd).eval(); };
    ASSERT_LT((arm.coriolis(at.q, at.qd) * at.qd - rate_of(momentum, at) + gradient).norm(), 1e-8);
  });
}

TEST(Premium, HasTheGradientOfItsPotentialEnergyAsGravity) {
  over_the_workspace([](const Motion& at) {
    for (int joint = 0; joint < 3; ++joint) {
      const Vector d = step * Vector::Unit(joint);
      const double slope = (arm.potential_energy(at.q + d) - arm.potential_energy(at.q - d)) / (2.0 * step);
      ASSERT_NEAR(arm.gravity(at.q)[joint], slope, 1e-9);
    }
  });
  EXPECT_EQ(Premium({.with_gravity = false}).gravity({0.1, 0.2, 0.3}), Vector::Zero());
}

/// One step of the classical Runge-Kutta method of fourth order, without input.
Motion stepped(const Motion& from, double dt) {
  const auto slope = [](const Motion& at) {
    return Motion{at.qd, arm.acceleration(at.q, at.qd, Vector::Zero())};
  };
  const auto moved = [&](const Motion& by, double t) {
    return Motion{from.q + t * by.q, from.qd + t * by.qd};
  };
  const Motion k1 = slope(from);
  const Motion k2 = slope(moved(k1, 0.5 * dt));
  const Motion k3 = slope(moved(k2, 0.5 * dt));
  const Motion k4 = slope(moved(k3, dt));
  return {from.q + dt / 6.0 * (k1.q + 2.0 * k2.q + 2.0 * k3.q + k4.q),
          from.qd + dt / 6.0 * (k1.qd + 2.0 * k2.qd + 2.0 * k3.qd + k4.qd)};
}

TEST(Premium, KeepsItsEnergyWhenNothingActsOnIt) {
  for (const Vector& speed : {Vector(0.0, 0.0, 0.0), Vector(3.0, 0.0, 0.0), Vector(2.0, -1.0, 4.0)}) {
    Motion at{Vector(0.1, 0.2, -0.1), speed};
    const auto energy = [&] { return arm.kinetic_energy(at.q, at.qd) + arm.potential_energy(at.q); };
    const double before = energy();
    double largest = 0.0;
    double off = 0.0;
    for (int i = 0; i < 50000; ++i) {
      at = stepped(at, 2e-4);
      largest = std::max(largest, arm.kinetic_energy(at.q, at.qd));
      off = std::max(off, std::abs(energy() - before));
    }
    EXPECT_LT(off, 1e-8 * largest) << "over 10 s from " << speed.transpose();
  }
}

TEST(Premium, AcceleratesByTheInverseOfItsInertia) {
  over_the_workspace([](const Motion& at) {
    const Vector torque(0.3, -0.2, 0.1);
    const Vector qdd = arm.acceleration(at.q, at.qd, torque);
    const Vector sum = arm.inertia(at.q) * qdd + arm.coriolis(at.q, at.qd) * at.qd + arm.gravity(at.q);
    ASSERT_LT((sum - torque).norm(), 1e-14);
  });
}

TEST(Premium, SaysTheSameAllAtOnceAsOneByOne) {
  over_the_workspace([](const Motion& at) {
    const Premium::Dynamics all = arm.dynamics(at.q, at.qd);
    ASSERT_EQ(all.inertia, arm.inertia(at.q));
    ASSERT_EQ(all.coriolis, arm.coriolis(at.q, at.qd));
    ASSERT_LT((all.coriolis_torque - all.coriolis * at.qd).norm(), 1e-15);
    ASSERT_EQ(all.gravity, arm.gravity(at.q));
    ASSERT_EQ(all.jacobian, Premium::jacobian(at.q));
    ASSERT_LT((all.jacobian_rate_times_v - Premium::jacobian_rate(at.q, at.qd) * at.qd).norm(), 1e-15);
    ASSERT_EQ(all.tip, Premium::tip(at.q));
  });
}

TEST(Premium, AllocatesNothing) {
  Motions draw;
  const Motion at = draw();
  double sum = 0.0;
  const std::size_t before = test::allocations();
  for (int i = 0; i < 100; ++i) {
    sum += arm.dynamics(at.q, at.qd).tip[0] + arm.acceleration(at.q, at.qd, at.q)[0];
    sum += Premium::joint_angles(Premium::tip(at.q)).value_or(at.q)[0];
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(Premium, RefusesAPayloadThatIsNoMass) {
  EXPECT_THROW(Premium({.payload_kg = -0.1}), std::invalid_argument);
  EXPECT_THROW(Premium({.payload_kg = std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::mechanisms
