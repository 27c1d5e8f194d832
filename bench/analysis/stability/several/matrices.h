#pragma once

#include <Eigen/Core>

namespace kerf::bench {

/// What studies of several axes need of square matrices, compiled once.

/// Largest modulus of the eigenvalues.
[[nodiscard]] double largest_modulus(const Eigen::MatrixXd& matrix);
/// Least eigenvalue of a symmetric matrix.
[[nodiscard]] double least_eigenvalue(const Eigen::MatrixXd& symmetric);
/// Largest singular value.
[[nodiscard]] double largest_singular_value(const Eigen::MatrixXd& matrix);
/// M^-1/2 of a symmetric positive definite matrix.
[[nodiscard]] Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& symmetric);
/// A symmetric matrix with its negative eigenvalues set to 0.
[[nodiscard]] Eigen::MatrixXd positive_part(const Eigen::MatrixXd& symmetric);
/// ((B^T B)^1/2 + (B B^T)^1/2) / 2.
[[nodiscard]] Eigen::MatrixXd mean_modulus(const Eigen::MatrixXd& matrix);
/// exp(A): Taylor's series of a small part of A, squared up to all of it.
[[nodiscard]] Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix);
/// M^-1 A.
[[nodiscard]] Eigen::MatrixXd divided_by(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& matrix);

}  // namespace kerf::bench
