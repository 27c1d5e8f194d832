#include "stability/several/sampled_axes.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "stability/device/sampled_device.h"
#include "stability/device/sampled_loop.h"
#include "stability/several/matrices.h"

namespace kerf::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

void demand_shape(const MatrixXd& matrix, Index axes, const char* what) {
  if (matrix.rows() == axes && matrix.cols() == axes && matrix.allFinite()) return;
  throw std::invalid_argument(fmt::format("{} is {} by {}, expected {} by {} finite numbers", what,
                                          matrix.rows(), matrix.cols(), axes, axes));
}

void demand_symmetric(const MatrixXd& matrix, const char* what) {
  constexpr double rounding = 1e-9;
  const double largest = matrix.cwiseAbs().maxCoeff();
  for (Index row = 0; row < matrix.rows(); ++row) {
    for (Index column = 0; column < row; ++column) {
      if (std::abs(matrix(row, column) - matrix(column, row)) <= rounding * largest) continue;
      throw std::invalid_argument(
          fmt::format("{} is not symmetric: {} in row {}, column {}, and {} across it", what,
                      matrix(row, column), row + 1, column + 1, matrix(column, row)));
    }
  }
}

void demand_definite(const MatrixXd& matrix, bool strictly, const char* what) {
  demand_symmetric(matrix, what);
  const double least = least_eigenvalue(matrix);
  const double rounding = -1e-9 * matrix.cwiseAbs().maxCoeff();
  if (strictly ? least > 0.0 : least >= rounding) return;
  throw std::invalid_argument(fmt::format("{} has the eigenvalue {:.4g}, expected none {}", what, least,
                                          strictly ? "that is 0 or less" : "below 0"));
}

/// Of x, v and a constant force over a time: the rows of x and v of the exponential.
MatrixXd motion_over(const SampledAxes& device, double time_s) {
  const Index n = device.axes();
  const auto per_mass = [&](const MatrixXd& matrix) { return divided_by(device.mass, matrix); };
  MatrixXd rates = MatrixXd::Zero(3 * n, 3 * n);
  rates.block(0, n, n, n).setIdentity();
  if (device.stiffness.size() > 0) rates.block(n, 0, n, n) = -per_mass(device.stiffness);
  rates.block(n, n, n, n) = -per_mass(device.damping);
  rates.block(n, 2 * n, n, n) = per_mass(MatrixXd::Identity(n, n));
  return exponential(time_s * rates).topRows(2 * n);
}

SplitDelay split(const SampledAxes& device) {
  SampledDevice timing;
  timing.period_s = device.period_s;
  timing.delay_s = device.delay_s;
  return SplitDelay(timing);
}

}  // namespace

void check(const SampledAxes& device) {
  const Index n = device.axes();
  if (n < 1 || n > SampledAxes::max_axes) {
    throw std::invalid_argument(
        fmt::format("the mass matrix has {} rows, expected 1 to {}", n, SampledAxes::max_axes));
  }
  demand_shape(device.mass, n, "the mass matrix");
  demand_shape(device.damping, n, "the damping matrix");
  demand_definite(device.mass, true, "the mass matrix");
  demand_definite(device.damping, false, "the damping matrix");
  if (device.stiffness.size() > 0) {
    demand_shape(device.stiffness, n, "the hand's stiffness matrix");
    demand_definite(device.stiffness, false, "the hand's stiffness matrix");
  }
  SampledDevice timing;  // which has the same limits
  timing.period_s = device.period_s;
  timing.delay_s = device.delay_s;
  timing.velocity_corner_rad_s = device.velocity_corner_rad_s;
  check(timing);
}

void check(const WallOfAxes& wall, const SampledAxes& device) {
  demand_shape(wall.stiffness, device.axes(), "the wall's stiffness matrix");
  demand_shape(wall.damping, device.axes(), "the wall's damping matrix");
}

SystemOfAxes::SystemOfAxes(const SampledAxes& device) : axes_(device.axes()), period_s_(device.period_s) {
  check(device);
  const SplitDelay delay = split(device);
  delay_ticks_ = delay.ticks;
  share_ = delay.share;
  SampledDevice filter;
  filter.period_s = device.period_s;
  filter.velocity_corner_rad_s = device.velocity_corner_rad_s;
  gain_ = filter.velocity_gain();
  size_ = (5 + static_cast<Index>(delay_ticks_)) * axes_;
  if (share_ > 0.0) before_ = motion_over(device, share_ * device.period_s);
  after_ = motion_over(device, (1.0 - share_) * device.period_s);
}

MatrixXd SystemOfAxes::tick(const WallOfAxes& wall) const {
  const Index n = axes_;
  const MatrixXd all = MatrixXd::Identity(size_, size_);
  const auto part = [&](Index at) { return all.middleRows(at * n, n); };
  const MatrixXd filtered = (1.0 - gain_) * part(3) + gain_ / period_s_ * (part(0) - part(2));
  const MatrixXd command = -wall.stiffness * part(0) - wall.damping * filtered;
  const auto ticks = static_cast<Index>(delay_ticks_);
  const MatrixXd arrived = ticks == 0 ? command : MatrixXd(part(4 + ticks));
  MatrixXd moving(3 * n, size_);  // x, v and the force that is held, of the state before the tick
  moving.topRows(2 * n) = all.topRows(2 * n);
  moving.bottomRows(n) = part(4);
  if (share_ > 0.0) moving.topRows(2 * n) = (before_ * moving).eval();
  moving.bottomRows(n) = arrived;
  MatrixXd system(size_, size_);
  system.topRows(2 * n) = after_ * moving;
  system.middleRows(2 * n, n) = part(0);
  system.middleRows(3 * n, n) = filtered;
  system.middleRows(4 * n, n) = arrived;
  for (Index i = 0; i < ticks; ++i)
    system.middleRows((5 + i) * n, n) = i == 0 ? command : MatrixXd(part(4 + i));
  return system;
}

double SystemOfAxes::spectral_radius(const WallOfAxes& wall) const { return largest_modulus(tick(wall)); }

void SystemOfAxes::step(const WallOfAxes& wall, Eigen::VectorXd& state) const {
  const Index n = axes_;
  const Eigen::VectorXd read = state.segment(0, n);
  Eigen::VectorXd velocity = state.segment(3 * n, n);
  velocity += gain_ * ((read - state.segment(2 * n, n)) / period_s_ - velocity);
  Eigen::VectorXd force = -(wall.stiffness * read) - wall.damping * velocity;
  for (std::size_t i = 0; i < delay_ticks_; ++i) {  // the newest command goes in, the oldest comes out
    const Index at = (5 + static_cast<Index>(i)) * n;
    Eigen::VectorXd older = state.segment(at, n);
    state.segment(at, n) = force;
    force = std::move(older);
  }
  Eigen::VectorXd moving(3 * n);
  moving << state.segment(0, 2 * n), state.segment(4 * n, n);
  if (share_ > 0.0) moving.head(2 * n) = (before_ * moving).eval();
  moving.tail(n) = force;
  state.segment(0, 2 * n) = after_ * moving;
  state.segment(2 * n, n) = read;
  state.segment(3 * n, n) = velocity;
  state.segment(4 * n, n) = force;
}

double simulated_growth(const SystemOfAxes& system, const WallOfAxes& wall, int doublings) {
  MatrixXd motions(system.size(), system.size());
  for (Index start = 0; start < system.size(); ++start) {
    Eigen::VectorXd state = Eigen::VectorXd::Unit(system.size(), start);
    system.step(wall, state);
    motions.col(start) = state;
  }
  double logarithm = 0.0;  // of what was taken out of the motions so that they stay of size 1
  for (int i = 0; i < doublings; ++i) {
    const double size = motions.norm();
    if (size == 0.0) return -std::numeric_limits<double>::infinity();
    motions /= size;
    logarithm = 2.0 * (logarithm + std::log(size));
    motions = (motions * motions).eval();
  }
  return std::ldexp(logarithm + std::log(motions.norm()), -doublings);
}

}  // namespace kerf::bench
