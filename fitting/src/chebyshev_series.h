#pragma once

#include <vector>

#include <Eigen/Core>

namespace kerf::fitting {

/// A function between two ends as a sum of polynomials of Chebyshev, sum_k T_k(u) c_k, u = -1 at the lower
/// end and 1 at the upper. What is left out of one that is analytic about them falls by a constant factor a
/// term [Trefethen2019], theorem 8.2.
class ChebyshevSeries {
 public:
  /// @param lower,upper  ends, lower < upper
  /// @param terms        at least 1
  ChebyshevSeries(double lower, double upper, Eigen::Index terms)
      : middle_(0.5 * (lower + upper)), half_(0.5 * (upper - lower)), terms_(terms) {}

  [[nodiscard]] Eigen::Index terms() const { return terms_; }
  [[nodiscard]] double lower() const { return middle_ - half_; }
  [[nodiscard]] double upper() const { return middle_ + half_; }
  [[nodiscard]] bool holds_at(double x) const { return x >= lower() && x <= upper(); }
  /// Where the values of a function tell the series, from the upper end down; the middle is one of an odd
  /// number.
  [[nodiscard]] std::vector<double> nodes() const;
  /// From values at the nodes to c, terms x terms.
  [[nodiscard]] Eigen::MatrixXd from_nodes() const;
  /// What each c counts for at a place, and its derivative.
  struct At {
    Eigen::VectorXd value, slope;
  };
  [[nodiscard]] At at(double x) const;

 private:
  double middle_, half_;
  Eigen::Index terms_;
};

/// How many terms leave a share of a function that is analytic for |Im x| < strip, between ends so far apart.
[[nodiscard]] Eigen::Index terms_that_leave(double share, double strip, double apart);

}  // namespace kerf::fitting
