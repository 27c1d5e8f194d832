#pragma once

#include <cstddef>
#include <map>

#include <Eigen/Core>
#include <Eigen/LU>

namespace kerf::identification {

/// What data that err together add to the normal equations: J' J and J' r.
struct Cluster {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;

  Cluster() = default;
  explicit Cluster(Eigen::Index numbers)
      : matrix(Eigen::MatrixXd::Zero(numbers, numbers)), gradient(Eigen::VectorXd::Zero(numbers)) {}
  Cluster(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual)
      : matrix(columns.transpose() * columns), gradient(columns.transpose() * residual) {}

  Cluster& operator+=(const Cluster& other) {
    if (gradient.size() == 0) return *this = other;
    matrix += other.matrix;
    gradient += other.gradient;
    return *this;
  }
};

/// Covariance of least squares by the jackknife over C clusters, by one step each [ShaoTu1995], from the
/// inverse of H, the sum of all H_c:
///
///     H^-1 (sum_c g_c g_c') H^-1 (C - 1) / C,   g_c = (I - H_c H^-1)^-1 J_c' r_c
inline Eigen::MatrixXd jackknife(const Eigen::MatrixXd& inverse,
                                 const std::map<std::size_t, Cluster>& clusters) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(inverse.rows(), inverse.cols());
  Eigen::MatrixXd between = Eigen::MatrixXd::Zero(inverse.rows(), inverse.cols());
  const auto count = static_cast<double>(clusters.size());
  for (const auto& [name, cluster] : clusters) {
    // What the result would change by without the cluster.
    const Eigen::VectorXd gradient =
        Eigen::MatrixXd(one - cluster.matrix * inverse).partialPivLu().solve(cluster.gradient);
    between += gradient * gradient.transpose();
  }
  return inverse * between * inverse * ((count - 1.0) / count);
}

}  // namespace kerf::identification
