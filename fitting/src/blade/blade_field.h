#pragma once

#include <array>
#include <vector>

#include "blade/blade_rows.h"

namespace kerf::fitting {

/// Rows of a linear problem: force = columns * (edge, normal, tangential) + noise.
struct FieldRows {
  std::vector<Columns> columns;
  std::vector<Vector6d> force;

  [[nodiscard]] std::size_t size() const noexcept { return force.size(); }
};

/// The three coefficients of a field, with their uncertainty.
struct FieldFit {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d std_error = Eigen::Vector3d::Zero();
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
  std::array<bool, 3> absent{};           ///< no row depends on it
  std::array<bool, 3> undetermined{};     ///< absent, or part of a combination that no row depends on
  Vector6d deviation = Vector6d::Ones();  ///< by which each axis was divided; infinite: left out
  Vector6d correlation_time = Vector6d::Ones();
  std::vector<Vector6d> residuals;
};

/// Weighted least squares with no coefficient below zero, and its intervals.
[[nodiscard]] FieldFit fit_field(const FieldRows& rows, const BladeFitOptions& options);

}  // namespace kerf::fitting
