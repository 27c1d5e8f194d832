#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "stability/several/directions.h"
#include "stability/several/matrices.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;

MatrixXd diagonal(double first, double second) {
  return Eigen::Vector2d(first, second).asDiagonal().toDenseMatrix();
}

SampledAxes coupled_axes() {
  SampledAxes device;
  device.mass = (Matrix2d() << 0.2, 0.06, 0.06, 0.08).finished();
  device.damping = (Matrix2d() << 0.5, 0.1, 0.1, 0.3).finished();
  return device;
}

WallOfAxes spring(const MatrixXd& stiffness) {
  return {.stiffness = stiffness, .damping = MatrixXd::Zero(stiffness.rows(), stiffness.cols())};
}

/// A number between, by the seed.
class Drawn {
 public:
  explicit Drawn(unsigned seed) : engine_(seed) {}
  double between(double lower, double upper) {
    return lower + (upper - lower) * (static_cast<double>(engine_() >> 8U) * 0x1p-24);
  }
  MatrixXd matrix(Eigen::Index n) {
    MatrixXd all(n, n);
    for (double& entry : all.reshaped()) entry = between(-1.0, 1.0);
    return all;
  }

 private:
  std::mt19937 engine_;
};

TEST(SeveralAxes, OfOneAxisAreTheOneAxis) {
  for (const double delay_periods : {0.0, 0.3, 2.0, 2.7}) {
    SampledDevice one{.mass_kg = 0.1,
                      .viscous_n_s_per_m = 0.4,
                      .delay_s = 1e-3 * delay_periods,
                      .velocity_corner_rad_s = 300.0,
                      .hand = {.stiffness_n_per_m = 200.0}};
    SampledAxes axes{.mass = MatrixXd::Constant(1, 1, 0.1),
                     .damping = MatrixXd::Constant(1, 1, 0.4),
                     .stiffness = MatrixXd::Constant(1, 1, 200.0),
                     .delay_s = one.delay_s,
                     .velocity_corner_rad_s = 300.0};
    const WallOfAxes wall{.stiffness = MatrixXd::Constant(1, 1, 700.0),
                          .damping = MatrixXd::Constant(1, 1, 0.3)};
    EXPECT_NEAR(SystemOfAxes(axes).spectral_radius(wall), spectral_radius(one, {700.0, 0.3}), 1e-10);
  }
}

TEST(SeveralAxes, HaveTheGrowthOfUncoupledAxesInAnyCoordinates) {
  // Two axes of z^2 - (2 - q) z + (1 + q), q = K T^2 / 2 M, mixed by a matrix: M = P^T P, K = P^T k P.
  const Matrix2d mix = (Matrix2d() << 1.0, 0.4, -0.3, 0.8).finished();
  SampledAxes device;
  device.mass = 0.1 * mix.transpose() * mix;
  device.damping = Matrix2d::Zero();
  const WallOfAxes wall = spring(mix.transpose() * diagonal(500.0, 900.0) * mix);
  const double q = 900.0 * 1e-6 / 0.2;
  EXPECT_NEAR(SystemOfAxes(device).spectral_radius(wall), std::sqrt(1.0 + q), 1e-10);
}

TEST(SeveralAxes, SimulatedGrowAsTheirEigenvaluesSay) {
  Drawn drawn(3);
  for (const Eigen::Index n : {1, 2, 3, 6}) {
    for (const double delay_periods : {0.0, 1.4}) {
      const MatrixXd root = drawn.matrix(n);
      SampledAxes device{.mass = 0.2 * MatrixXd::Identity(n, n) + 0.05 * root * root.transpose(),
                         .damping = 0.3 * MatrixXd::Identity(n, n),
                         .stiffness = {},
                         .delay_s = 1e-3 * delay_periods,
                         .velocity_corner_rad_s = 400.0};
      const WallOfAxes wall{.stiffness = 300.0 * (MatrixXd::Identity(n, n) + 0.5 * drawn.matrix(n)),
                            .damping = 0.2 * drawn.matrix(n)};
      const SystemOfAxes system(device);
      EXPECT_NEAR(simulated_growth(system, wall), std::log(system.spectral_radius(wall)), 1e-11) << n;
    }
  }
}

TEST(SeveralAxes, SpiralOnASkewSpringAsTheirComplexNumberDoes) {
  // M z'' + b z' = -(K + j N) z of z = x + j y: the polynomial of one axis with a complex stiffness.
  constexpr double m = 0.1;
  constexpr double b = 0.6;
  constexpr double t = 1e-3;
  SampledAxes device{.mass = diagonal(m, m), .damping = diagonal(b, b), .stiffness = {}};
  const Matrix2d stiffness = (Matrix2d() << 400.0, -150.0, 150.0, 400.0).finished();
  const double e = std::exp(-b * t / m);
  const double xv = m / b * (1.0 - e);
  const double xf = (t - xv) / b;
  const double vf = (1.0 - e) / b;
  double largest = 0.0;
  for (const double side : {1.0, -1.0}) {
    const std::complex<double> k(400.0, 150.0 * side);
    const std::complex<double> half = 0.5 * (1.0 - k * xf + e);
    const std::complex<double> product = (1.0 - k * xf) * e + k * vf * xv;
    const std::complex<double> root = std::sqrt(half * half - product);
    largest = std::max({largest, std::abs(half + root), std::abs(half - root)});
  }
  EXPECT_NEAR(SystemOfAxes(device).spectral_radius(spring(stiffness)), largest, 1e-12);
}

TEST(TurningWall, OnEvenAxesIsAStandingOneInTheFrameOfTheTool) {
  // With M and D alike in all directions x_k = R(w k T) z_k makes the ticks the same ones.
  SampledAxes device{.mass = diagonal(0.1, 0.1), .damping = diagonal(0.4, 0.4), .stiffness = {}};
  const SystemOfAxes system(device);
  const TurningWall wall{.wall = spring(diagonal(900.0, 200.0)),
                         .rate_rad_s = 2.0 * std::numbers::pi / (250.0 * device.period_s)};
  ASSERT_EQ(ticks_of_a_turn(wall, device.period_s), 250U);
  const Matrix2d back = rotation_in_plane(2, 0, 1, -2.0 * std::numbers::pi / 250.0);
  MatrixXd turned = MatrixXd::Zero(10, 10);
  for (int part = 0; part < 5; ++part) turned.block(2 * part, 2 * part, 2, 2) = back;
  const MatrixXd in_tool = turned * system.tick(wall.wall);
  const double standing = std::log(largest_modulus(in_tool));
  EXPECT_NEAR(growth(system, wall, device.period_s), standing, 1e-10);
  EXPECT_NEAR(simulated_growth(system, wall, device.period_s), standing, 1e-10);
}

TEST(TurningWall, ThatDragsPushesSideways) {
  const TurningWall wall{.wall = {.stiffness = diagonal(100.0, 100.0), .damping = diagonal(2.0, 2.0)},
                         .rate_rad_s = 10.0,
                         .drags = true};
  // -B (x' - w J x): at rest beside the middle it is dragged along, towards the second axis.
  const Eigen::Vector2d force = -wall_at(wall, 0.3).stiffness * Eigen::Vector2d(1.0, 0.0);
  EXPECT_NEAR(force[0], -100.0, 1e-12);
  EXPECT_NEAR(force[1], 20.0, 1e-12);
}

TEST(TurningWall, TakesWholeTicksForATurn) {
  TurningWall wall{.wall = spring(diagonal(1.0, 1.0)), .rate_rad_s = 2.0 * std::numbers::pi};
  EXPECT_EQ(ticks_of_a_turn(wall, 1e-3), 1000U);
  wall.rate_rad_s = 1e-3;
  EXPECT_THROW((void)ticks_of_a_turn(wall, 1e-3), std::invalid_argument);
}

TEST(SufficientCondition, OfOneAxisIsColgateAndSchenkels) {
  SampledAxes device{
      .mass = MatrixXd::Constant(1, 1, 0.1), .damping = MatrixXd::Constant(1, 1, 0.4), .stiffness = {}};
  const auto holds = [&](double k, double b) {
    return sufficient_condition(device, {.wall = {.stiffness = MatrixXd::Constant(1, 1, k),
                                                  .damping = MatrixXd::Constant(1, 1, b)}})
        .holds();
  };
  for (const double b : {0.0, 0.1, 0.3, -0.1}) {
    const double k = colgate_schenkel({.mass_kg = 0.1, .viscous_n_s_per_m = 0.4}, b);
    EXPECT_TRUE(holds(0.9999 * k, b)) << b;
    EXPECT_FALSE(holds(1.0001 * k, b)) << b;
  }
}

TEST(SufficientCondition, WithoutSamplingIsThatOfACirculatorySystem) {
  // l^2 + d l + k + i nu is stable if d^2 k > nu^2.
  SampledAxes device{
      .mass = diagonal(0.5, 0.5), .damping = diagonal(2.0, 2.0), .stiffness = {}, .period_s = 1e-5};
  const auto holds = [&](double skew) {
    const Matrix2d stiffness = (Matrix2d() << 300.0, -skew, skew, 300.0).finished();
    return sufficient_condition(device, {.wall = spring(stiffness)}).holds();
  };
  const double limit = 2.0 / 0.5 * std::sqrt(300.0 / 0.5) * 0.5;
  EXPECT_TRUE(holds(0.99 * limit));
  EXPECT_FALSE(holds(1.01 * limit));
}

TEST(SufficientCondition, NeverHoldsOfWhatIsNotStable) {
  Drawn drawn(11);
  int held = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Index n = 2 + i % 2;
    const MatrixXd root = drawn.matrix(n);
    const MatrixXd friction = drawn.matrix(n);
    const MatrixXd spring_root = drawn.matrix(n);
    SampledAxes device{.mass = 0.1 * MatrixXd::Identity(n, n) + 0.1 * root * root.transpose(),
                       .damping = MatrixXd::Identity(n, n) + friction * friction.transpose(),
                       .stiffness = 50.0 * MatrixXd::Identity(n, n),
                       .delay_s = i % 3 == 0 ? 1e-3 * drawn.between(0.0, 2.0) : 0.0,
                       .velocity_corner_rad_s = i % 4 == 0 ? 300.0 : 0.0};
    const MatrixXd any = drawn.matrix(n);
    TurningWall wall{
        .wall = {.stiffness = drawn.between(0.0, 2000.0) * spring_root * spring_root.transpose() +
                              drawn.between(0.0, 60.0) * (any - any.transpose()),
                 .damping = drawn.between(0.0, 0.3) * drawn.matrix(n)}};
    if (i % 5 == 0) wall.rate_rad_s = drawn.between(20.0, 200.0);
    wall.drags = i % 10 == 0;
    if (!sufficient_condition(device, wall).holds()) continue;
    ++held;
    EXPECT_LT(growth(SystemOfAxes(device), wall, device.period_s), 0.0) << i;
  }
  EXPECT_GT(held, 50) << "of the draws many enough are judged";
}

TEST(DirectionMap, SimulationAndEigenvaluesAgreeToAMillionth) {
  NamedAxes axes{.names = {"x", "y"}, .device = coupled_axes()};
  TurningWall shape{.wall = spring(diagonal(1.0, 0.25))};
  const DirectionMap standing = direction_map(axes, shape, 12, {.begin = 1.0, .end = 1e5}, {});
  EXPECT_LT(standing.boundary_error(), 1e-6);
  for (const DirectionBoundary& at : standing.boundaries) {
    EXPECT_GT(at.eigenvalues, 100.0);
    EXPECT_LT(at.sufficient, at.eigenvalues);
    EXPECT_LE(at.passive, at.sufficient * (1.0 + 1e-6));
  }
  axes.device.delay_s = 1.3e-3;
  axes.device.velocity_corner_rad_s = 200.0;
  shape.wall.damping = diagonal(0.1, 0.05);
  EXPECT_LT(direction_map(axes, shape, 5, {.begin = 1.0, .end = 1e5}, {}).boundary_error(), 1e-6);
  shape.rate_rad_s = 60.0;
  const DirectionMap turning = direction_map(axes, shape, 3, {.begin = 1.0, .end = 1e5}, {});
  EXPECT_LT(turning.boundary_error(), 1e-6);
  EXPECT_EQ(turning.boundaries[0].eigenvalues, turning.boundaries[2].eigenvalues);
}

TEST(DirectionMap, OfUncoupledAxesAlongOneIsThatAxisAlone) {
  NamedAxes axes{.names = {"x", "y"},
                 .device = {.mass = diagonal(0.2, 0.05), .damping = diagonal(0.5, 0.2), .stiffness = {}}};
  const TurningWall shape{.wall = spring(diagonal(1.0, 0.0))};
  const DirectionMap map = direction_map(axes, shape, 2, {.begin = 1.0, .end = 1e5}, {});
  const double along_x = eigenvalue_boundary({.mass_kg = 0.2, .viscous_n_s_per_m = 0.5}, 0.0, 1.0, 1e5);
  const double along_y = eigenvalue_boundary({.mass_kg = 0.05, .viscous_n_s_per_m = 0.2}, 0.0, 1.0, 1e5);
  EXPECT_NEAR(map.boundaries[0].eigenvalues, along_x, 2e-6 * along_x);
  EXPECT_NEAR(map.boundaries[1].eigenvalues, along_y, 2e-6 * along_y);
  EXPECT_NEAR(map.boundaries[1].one_axis, along_y, 2e-6 * along_y);
}

TEST(SeveralAxes, RefuseMatricesThatNoDeviceHas) {
  const auto refuses = [](SampledAxes device) { EXPECT_THROW(SystemOfAxes{device}, std::invalid_argument); };
  SampledAxes device = coupled_axes();
  device.mass(0, 1) = 0.5;
  refuses(device);
  device = coupled_axes();
  device.mass *= -1.0;
  refuses(device);
  device = coupled_axes();
  device.damping = MatrixXd::Identity(3, 3);
  refuses(device);
  device.mass = MatrixXd::Identity(7, 7);
  refuses(device);
  EXPECT_THROW(check(spring(MatrixXd::Identity(3, 3)), coupled_axes()), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
