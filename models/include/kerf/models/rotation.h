#pragma once

#include <Eigen/Core>

namespace kerf::models {

/// Rotation matrix of a rotation vector r (Rodrigues): I + sin|r|/|r| [r] + (1 - cos|r|)/|r|^2 [r]^2.
[[nodiscard]] Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rotation_vector) noexcept;

/// Its left Jacobian J_l: the angular velocity of a frame whose rotation vector changes at a rate r' is
/// J_l(r) r'.
[[nodiscard]] Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation_vector) noexcept;

/// Rotation vector of a rotation matrix, of a length up to pi.
[[nodiscard]] Eigen::Vector3d rotation_vector_of(const Eigen::Matrix3d& rotation) noexcept;

}  // namespace kerf::models
