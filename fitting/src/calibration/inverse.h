#pragma once

#include <vector>

#include <Eigen/Core>

#include "calibration/signal_fit.h"

namespace kerf::fitting::calibration {

/// The errors of all coefficients of all signals together: what a linear function of them is uncertain by.
///
///     Cov(b_i, b_j) = s_ij L_i L_j^T + (L_i E_i) (L_j E_j)^T
///
/// s_ii = sigma_i²; s_ij of two signals by the moments of their residuals, where those are beyond three
/// standard deviations of nothing.
class CoefficientErrors {
 public:
  /// `load_errors` of each signal, E_i.
  CoefficientErrors(const std::vector<SignalFit>& fits, const std::vector<Eigen::MatrixXd>& load_errors,
                    const std::vector<Eigen::VectorXd>& signals);

  /// Half of the interval of the sum over signals of gradient.col(i)^T b_i; of a signal with fewer
  /// coefficients the first ones count. Student's t of Satterthwaite's degrees of freedom.
  [[nodiscard]] double half_width(const Eigen::MatrixXd& gradient, double confidence) const;

 private:
  const std::vector<SignalFit>* fits_;
  std::vector<Eigen::MatrixXd> from_loads_;  ///< L_i E_i
  Eigen::MatrixXd shared_;                   ///< s
};

/// C of an A and of weights, one a signal.
struct Inverse {
  Eigen::MatrixXd matrix;  ///< C = Q A^T W
  Eigen::MatrixXd normal;  ///< Q = (A^T W A)^-1
  Eigen::MatrixXd rest;    ///< I - A C
  Eigen::VectorXd weights;

  /// d C(component, column) / d A, signals x components.
  [[nodiscard]] Eigen::MatrixXd gradient(Eigen::Index component, Eigen::Index column) const;
};
[[nodiscard]] Inverse inverse_of(const Eigen::MatrixXd& sensitivity, const Eigen::VectorXd& weights);

}  // namespace kerf::fitting::calibration
