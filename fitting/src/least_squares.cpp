#include "least_squares.h"

#include <Eigen/QR>

namespace kerf::fitting {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

Eigen::VectorXd solve_normal(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right) {
  return normal.completeOrthogonalDecomposition().solve(right);
}

}  // namespace kerf::fitting
