#include "least_squares.h"

#include <Eigen/Dense>

namespace kerf::compare {

std::vector<double> nearest_sum(const std::vector<std::vector<double>>& columns,
                                std::span<const double> target) {
  const auto rows = static_cast<Eigen::Index>(target.size());
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd matrix(rows, count);
  Eigen::VectorXd scale(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    matrix.col(i) = Eigen::Map<const Eigen::VectorXd>(columns[static_cast<std::size_t>(i)].data(), rows);
    const double norm = matrix.col(i).norm();
    scale[i] = norm > 0.0 ? 1.0 / norm : 0.0;
    matrix.col(i) *= scale[i];
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factored;
  factored.setThreshold(1e-11);
  factored.compute(matrix);
  const Eigen::VectorXd weights =
      factored.solve(Eigen::Map<const Eigen::VectorXd>(target.data(), rows)).cwiseProduct(scale);
  return {weights.begin(), weights.end()};
}

}  // namespace kerf::compare
