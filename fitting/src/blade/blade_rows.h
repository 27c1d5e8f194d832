#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <kerf/fitting/blade.h>
#include <kerf/models/blade.h>

namespace kerf::fitting {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Columns = Eigen::Matrix<double, 6, 3>;  ///< of a field: edge, normal, tangential

/// A series as a blade sees it, one element a row.
struct BladeRows {
  models::BladeShape shape;
  models::BladeFidelity fidelity;
  std::vector<double> time_s;
  std::vector<models::Pose> pose;
  std::vector<models::Twist> twist;
  std::vector<Eigen::Matrix3d> jacobian;  ///< angular velocity over the rates of the rotation vector
  std::vector<Vector6d> force;
  std::vector<bool> in_tissue;
  double period_s = 0.0;  ///< median

  [[nodiscard]] std::size_t size() const noexcept { return pose.size(); }
  /// Whether no sample is missing between a row and the one before it.
  [[nodiscard]] bool follows(std::size_t row) const noexcept {
    return row > 0 && time_s[row] - time_s[row - 1] < 1.5 * period_s;
  }
};

/// @throws std::invalid_argument as fit_blade() does.
[[nodiscard]] BladeRows rows_of(const BladeSeries& series, const BladeFitOptions& options);

/// Generalised forces of the three unit fields at a row, of velocities or of displacements.
[[nodiscard]] Columns columns_of(const BladeRows& rows, std::size_t row, const models::Twist& twist);

/// Generalised force of a field at a row.
[[nodiscard]] Vector6d force_of(const BladeRows& rows, std::size_t row, const models::BladeField& field,
                                const models::Twist& twist);

/// Displacement of a row since the tool was at an anchor.
[[nodiscard]] models::Twist displacement_of(const models::Pose& pose, const models::Pose& anchor);

}  // namespace kerf::fitting
