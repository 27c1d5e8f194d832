#include "chebyshev_series.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <boost/math/special_functions/chebyshev.hpp>

namespace kerf::fitting {
namespace {

/// Of the node j, on the upper half of the circle whose shadow they are.
double angle_of(Eigen::Index j, Eigen::Index terms) {
  return std::numbers::pi * (static_cast<double>(j) + 0.5) / static_cast<double>(terms);
}

}  // namespace

std::vector<double> ChebyshevSeries::nodes() const {
  std::vector<double> nodes;
  for (Eigen::Index j = 0; j < terms_; ++j) nodes.push_back(middle_ + half_ * std::cos(angle_of(j, terms_)));
  return nodes;
}

Eigen::MatrixXd ChebyshevSeries::from_nodes() const {
  Eigen::MatrixXd cosines(terms_, terms_);
  for (Eigen::Index k = 0; k < terms_; ++k) {
    for (Eigen::Index j = 0; j < terms_; ++j) {
      cosines(k, j) = (k == 0 ? 1.0 : 2.0) / static_cast<double>(terms_) *
                      std::cos(static_cast<double>(k) * angle_of(j, terms_));
    }
  }
  return cosines;
}

ChebyshevSeries::At ChebyshevSeries::at(double x) const {
  const double u = (x - middle_) / half_;
  At at{.value = Eigen::VectorXd(terms_), .slope = Eigen::VectorXd(terms_)};
  double t = 1.0, t_before = u;               // T_0, T_-1
  double second = 0.0, second_before = -1.0;  // U_-1, U_-2 of the second kind: dT_k / du = k U_k-1
  for (Eigen::Index k = 0; k < terms_; ++k) {
    at.value[k] = t;
    at.slope[k] = static_cast<double>(k) * second / half_;
    t_before = std::exchange(t, boost::math::chebyshev_next(u, t, t_before));
    second_before = std::exchange(second, boost::math::chebyshev_next(u, second, second_before));
  }
  return at;
}

Eigen::Index terms_that_leave(double share, double strip, double apart) {
  return 1 + std::lround(std::ceil(-std::log(share) / std::asinh(2.0 * strip / apart)));
}

}  // namespace kerf::fitting
