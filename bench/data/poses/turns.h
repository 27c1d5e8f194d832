#pragma once

#include <span>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "poses/orientation_form.h"

namespace kerf::bench {

/// What is wrong with the numbers of an orientation, in words that go on from "columns 5 to 8 "; empty if
/// nothing is. A quaternion's norm is within 1e-3 of 1, a matrix is orthonormal within 1e-3 and no mirror.
/// NaN says that there is none, and is no fault.
[[nodiscard]] std::string fault_of(const OrientationForm& form, std::span<const double> values);

/// The rotation that they mean, of the norm 1; angles are in rad. NaN if one of them is.
[[nodiscard]] Eigen::Quaterniond turn_of(const OrientationForm& form, std::span<const double> values);

/// Rotation vectors of orientations one after the other, without jumps: r and r - 2 pi r/|r| are the same
/// rotation, and of all that are, the one nearest to that before is taken. So a turn that goes on past pi has
/// a vector longer than pi. The first is of a length up to pi.
class RotationPath {
 public:
  /// NaN for a rotation that is, and the path goes on from the last that was none.
  [[nodiscard]] Eigen::Vector3d next(const Eigen::Quaterniond& turn);

 private:
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
};

}  // namespace kerf::bench
