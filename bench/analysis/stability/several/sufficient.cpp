#include "stability/several/sufficient.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stability/device/sampled_device.h"
#include "stability/several/matrices.h"

namespace kerf::bench {
namespace {

using Eigen::MatrixXd;
MatrixXd symmetric_part(const MatrixXd& matrix) { return 0.5 * (matrix + matrix.transpose()); }

}  // namespace

bool SufficientCondition::holds() const noexcept {
  if (!(damping_left_per_s > 0.0)) return false;
  if (turning_per_s2 == 0.0) return stiffness_left_per_s2 >= 0.0;
  const double k = stiffness_left_per_s2;
  return k > 0.0 && 2.0 * k * damping_left_per_s >
                        turning_per_s2 * (lag_per_s + std::sqrt(4.0 * k + lag_per_s * lag_per_s));
}

SufficientCondition sufficient_condition(const SampledAxes& device, const TurningWall& wall) {
  check(device);
  check(wall.wall, device);
  const MatrixXd weight = inverse_root(device.mass);
  const auto weighted = [&](const MatrixXd& matrix) -> MatrixXd { return weight * matrix * weight; };
  const std::size_t ticks = ticks_of_a_turn(wall, device.period_s);
  // A turning matrix is its mean and parts of one and two turns a turn: few angles tell all of it.
  const std::size_t angles = wall.turns() ? std::min<std::size_t>(ticks, 360) : 1;
  const auto at = [&](std::size_t i) {
    return wall_at(wall, 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(angles));
  };
  MatrixXd mean = MatrixXd::Zero(device.axes(), device.axes());
  for (std::size_t i = 0; i < angles; ++i) mean += symmetric_part(at(i).stiffness);
  mean = weighted(mean / static_cast<double>(angles));
  double turning = 0.0;
  double turning_symmetric = 0.0;
  double damping = 0.0;
  const double t = device.period_s;
  const double delay = t * whole_periods(device.delay_s, t);
  const double lag = 2.0 * t / std::numbers::pi + delay;
  const MatrixXd friction =
      weighted(device.damping) - 0.5 * t * positive_part(mean) - delay * mean_modulus(mean);
  double friction_left = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < angles; ++i) {
    const WallOfAxes now = at(i);
    const MatrixXd other = weighted(now.stiffness) - mean;
    turning = std::max(turning, largest_singular_value(other));
    turning_symmetric = std::max(turning_symmetric, largest_singular_value(symmetric_part(other)));
    const MatrixXd damper = weighted(now.damping);
    damping = std::max(damping, largest_singular_value(damper));
    // What turns meets the speed of the tick before at another angle: its largest value counts in all.
    const MatrixXd taken =
        wall.turns() ? largest_singular_value(damper) * MatrixXd::Identity(damper.rows(), damper.cols())
                     : mean_modulus(damper);
    friction_left = std::min(friction_left, least_eigenvalue(friction - taken));
  }
  const double negligible = 1e-12 * largest_singular_value(mean);
  if (turning <= negligible) turning = turning_symmetric = 0.0;
  MatrixXd held = mean;
  if (device.stiffness.size() > 0) held += weighted(device.stiffness);
  const double stiffness_left = least_eigenvalue(held) - turning_symmetric;
  return {.damping_left_per_s = friction_left - lag * turning,
          .stiffness_left_per_s2 = std::abs(stiffness_left) <= negligible ? 0.0 : stiffness_left,
          .turning_per_s2 = turning,
          .lag_per_s = (largest_singular_value(mean) + turning) * lag + damping};
}

}  // namespace kerf::bench
