#pragma once

#include <Eigen/Core>

namespace kerf::fitting {

/// The x of least |A x - b|. Decompositions are slow to compile, so that each is compiled once, here.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The same from the normal equations A'A x = A'b; the shortest x where they leave a choice.
[[nodiscard]] Eigen::VectorXd solve_normal(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right);

}  // namespace kerf::fitting
