#include "calibration/signal_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <boost/math/tools/minima.hpp>

namespace kerf::fitting::calibration {
namespace {

struct Variance {
  double value;
  double degrees_of_freedom;
};

/// What is left of the signal once X is taken out, in the axes in which the loads' errors are independent:
/// squares, and the variance that the loads' errors have along each.
struct Leftover {
  Eigen::ArrayXd squares;
  Eigen::ArrayXd load_variance;
};

Leftover leftover_of(const Eigen::MatrixXd& columns, const Eigen::VectorXd& signal,
                     const Eigen::MatrixXd& load_error) {
  const Eigen::Index n = columns.rows();
  const Eigen::Index left = n - columns.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::VectorXd rest = (qr.householderQ().adjoint() * signal).tail(left);
  if (load_error.cols() == 0) return {rest.array().square(), Eigen::ArrayXd::Zero(left)};
  const Eigen::MatrixXd all = qr.householderQ().adjoint() * load_error;
  const Eigen::MatrixXd errors = all.bottomRows(left);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> own(errors * errors.transpose());
  return {(own.eigenvectors().transpose() * rest).array().square(), own.eigenvalues().array().max(0.0)};
}

/// The variance of the largest restricted likelihood; of its information 2 / Var = sum 1 / (sigma² + l)².
Variance restricted_likelihood(const Leftover& leftover) {
  const double mean = leftover.squares.mean();
  const double count = static_cast<double>(leftover.squares.size());
  if (leftover.load_variance.maxCoeff() <= 0.0) return {mean, count};
  const double smallest = std::max(1e-300, 1e-12 * mean);
  const auto minus_log = [&](double log_variance) {
    const Eigen::ArrayXd all = leftover.load_variance + std::exp(log_variance);
    return (all.log() + leftover.squares / all).sum();
  };
  const auto [place, value] = boost::math::tools::brent_find_minima(
      minus_log, std::log(smallest), std::log(std::max(smallest, 4.0 * mean) * 2.0), 30);
  const double variance = std::exp(place);
  const double information = (leftover.load_variance + variance).square().inverse().sum();
  return {variance, variance * variance * information};
}

}  // namespace

SignalFit fit_signal(const Eigen::MatrixXd& columns, const Eigen::VectorXd& signal,
                     const Eigen::MatrixXd& load_error) {
  const Variance variance = restricted_likelihood(leftover_of(columns, signal, load_error));
  SignalFit fit{.columns = columns,
                .estimator = {},
                .coefficients = {},
                .variance = variance.value,
                .degrees_of_freedom = variance.degrees_of_freedom};
  if (load_error.cols() == 0) {
    fit.estimator = (columns.transpose() * columns).ldlt().solve(columns.transpose());
  } else {
    Eigen::MatrixXd covariance = load_error * load_error.transpose();
    // Loads that are wrong and signals that are not: the weights would have no end.
    const double least = 1e-9 * std::max(1e-300, covariance.diagonal().mean());
    covariance.diagonal().array() += std::max(variance.value, least);
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    const Eigen::MatrixXd weighted = factor.solve(columns);
    fit.estimator = (columns.transpose() * weighted).ldlt().solve(weighted.transpose());
  }
  fit.coefficients = fit.estimator * signal;
  return fit;
}

}  // namespace kerf::fitting::calibration
