#include "calibration/inverse.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace kerf::fitting::calibration {
namespace {

double quantile(double confidence, double degrees_of_freedom) {
  const double upper = 0.5 * (1.0 + confidence);
  if (degrees_of_freedom > 1e6)
    return boost::math::quantile(boost::math::normal_distribution<double>(), upper);
  const boost::math::students_t_distribution<double> student(std::max(1.0, degrees_of_freedom));
  return boost::math::quantile(student, upper);
}

/// An orthonormal basis of what the columns span.
Eigen::MatrixXd basis_of(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

struct Rest {
  Eigen::MatrixXd basis;
  Eigen::VectorXd signal;      ///< residuals of least squares
  Eigen::MatrixXd load_error;  ///< what of the loads' errors is in them
};

/// Covariance of two signals' errors, the loads' apart, by the moment of their residuals.
double shared_moment(const Rest& one, const Rest& other) {
  const double rows = static_cast<double>(one.signal.size());
  const double overlap = (one.basis.transpose() * other.basis).squaredNorm();
  const double count = rows - static_cast<double>(one.basis.cols() + other.basis.cols()) + overlap;
  const double by_loads = one.load_error.cwiseProduct(other.load_error).sum();
  return (one.signal.dot(other.signal) - by_loads) / std::max(1.0, count);
}

}  // namespace

CoefficientErrors::CoefficientErrors(const std::vector<SignalFit>& fits,
                                     const std::vector<Eigen::MatrixXd>& load_errors,
                                     const std::vector<Eigen::VectorXd>& signals)
    : fits_(&fits) {
  const auto count = static_cast<Eigen::Index>(fits.size());
  std::vector<Rest> rests;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    from_loads_.emplace_back(fits[i].estimator * load_errors[i]);
    Rest rest{.basis = basis_of(fits[i].columns), .signal = signals[i], .load_error = load_errors[i]};
    rest.signal -= rest.basis * (rest.basis.transpose() * rest.signal).eval();
    rest.load_error -= rest.basis * (rest.basis.transpose() * rest.load_error).eval();
    rests.push_back(std::move(rest));
  }
  shared_.setZero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    shared_(i, i) = fits[at].variance;
    for (Eigen::Index j = 0; j < i; ++j) {
      const auto other = static_cast<std::size_t>(j);
      const double together = std::sqrt(fits[at].variance * fits[other].variance);
      const double free = std::min(fits[at].degrees_of_freedom, fits[other].degrees_of_freedom);
      const double correlation =
          std::clamp(shared_moment(rests[at], rests[other]) / std::max(1e-300, together), -0.95, 0.95);
      if (std::abs(correlation) * std::sqrt(free) < 3.0) continue;
      shared_(i, j) = shared_(j, i) = correlation * together;
    }
  }
}

double CoefficientErrors::half_width(const Eigen::MatrixXd& gradient, double confidence) const {
  const auto count = static_cast<Eigen::Index>(fits_->size());
  const auto rows = (*fits_)[0].estimator.cols();
  Eigen::MatrixXd of_holds(rows, count);  // of each signal: how its holds enter
  Eigen::VectorXd by_loads = Eigen::VectorXd::Zero(from_loads_[0].cols());
  double uncertain = 0.0;  // of the variance: sum of (sigma² |u|²)² / nu
  double alone = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const SignalFit& fit = (*fits_)[at];
    const Eigen::Index rows_here = std::min(gradient.rows(), fit.estimator.rows());
    const Eigen::VectorXd own_gradient = gradient.col(i).head(rows_here);
    of_holds.col(i) = fit.estimator.topRows(rows_here).transpose() * own_gradient;
    by_loads += from_loads_[at].topRows(rows_here).transpose() * own_gradient;
    const double own = fit.variance * of_holds.col(i).squaredNorm();
    alone += own;
    uncertain += own * own / std::max(1e-9, fit.degrees_of_freedom);
  }
  const double of_signals =
      std::max(0.1 * alone, (of_holds.transpose() * of_holds).cwiseProduct(shared_).sum());
  const double variance = of_signals + by_loads.squaredNorm();
  if (variance <= 0.0) return 0.0;
  return quantile(confidence, variance * variance / std::max(1e-300, uncertain)) * std::sqrt(variance);
}

Inverse inverse_of(const Eigen::MatrixXd& sensitivity, const Eigen::VectorXd& weights) {
  Inverse inverse{.matrix = {}, .normal = {}, .rest = {}, .weights = weights};
  const Eigen::MatrixXd weighted = weights.asDiagonal() * sensitivity;
  inverse.normal = (sensitivity.transpose() * weighted).inverse();
  const bool square = sensitivity.rows() == sensitivity.cols();
  inverse.matrix = square ? Eigen::MatrixXd(sensitivity.inverse())
                          : Eigen::MatrixXd(inverse.normal * weighted.transpose());
  inverse.rest =
      Eigen::MatrixXd::Identity(sensitivity.rows(), sensitivity.rows()) - sensitivity * inverse.matrix;
  if (square) inverse.rest.setZero();
  return inverse;
}

Eigen::MatrixXd Inverse::gradient(Eigen::Index component, Eigen::Index column) const {
  // dC = -C dA C + Q dA^T W (I - A C)
  return -matrix.row(component).transpose() * matrix.col(column).transpose() +
         (weights.asDiagonal() * rest.col(column)) * normal.row(component);
}

}  // namespace kerf::fitting::calibration
