#pragma once

#include <Eigen/Core>

namespace kerf::fitting::calibration {

/// One signal by generalised least squares: y = X b + e, covariance sigma² I + E E^T.
struct SignalFit {
  Eigen::MatrixXd columns;          ///< X, n x p
  Eigen::MatrixXd estimator;        ///< L, p x n: b = L y
  Eigen::VectorXd coefficients;     ///< b
  double variance = 0.0;            ///< sigma², by restricted likelihood
  double degrees_of_freedom = 0.0;  ///< of sigma²: 2 sigma⁴ over its own variance
};

/// `load_error` is E, n x q; no columns: none. Requires more rows than columns in X, of full rank.
[[nodiscard]] SignalFit fit_signal(const Eigen::MatrixXd& columns, const Eigen::VectorXd& signal,
                                   const Eigen::MatrixXd& load_error);

}  // namespace kerf::fitting::calibration
