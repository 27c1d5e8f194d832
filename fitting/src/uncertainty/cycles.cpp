#include "uncertainty/cycles.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace kerf::fitting {
namespace {

using Eigen::Index;

constexpr double nearly_all =
    0.999;  ///< of what is known of a direction, in one cycle: hardly another has any

/// What one cycle has to say.
struct OneCycle {
  Eigen::MatrixXd share;  ///< M_c, of all that is known
  Eigen::MatrixXd root;   ///< (I - M_c)^(-1/2)
  Eigen::VectorXd score;  ///< u_c
};

OneCycle cycle_of(const Linearisation& linearisation, Index begin, Index count,
                  const Eigen::MatrixXd& basis) {
  const auto rows = linearisation.jacobian.middleRows(begin, count);
  OneCycle cycle;
  cycle.share = basis.transpose() * (rows.transpose() * rows) * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(cycle.share);
  const Eigen::VectorXd left = (1.0 - spectrum.eigenvalues().array().min(nearly_all)).rsqrt();
  cycle.root = spectrum.eigenvectors() * left.asDiagonal() * spectrum.eigenvectors().transpose();
  cycle.score =
      cycle.root * (basis.transpose() * (rows.transpose() * linearisation.residuals.segment(begin, count)));
  return cycle;
}

/// (tr G)^2 / tr(G^2) of the quadratic form that estimates the variance along a direction l of the basis:
/// G = diag(d) - W^T W, d_c = l^T R_c M_c R_c l, W the columns M_c R_c l.
double degrees_of_freedom(const std::vector<OneCycle>& cycles, const Eigen::VectorXd& direction) {
  const auto count = static_cast<Index>(cycles.size());
  Eigen::VectorXd d(count);
  Eigen::MatrixXd w(direction.size(), count);
  for (Index c = 0; c < count; ++c) {
    const OneCycle& cycle = cycles[static_cast<std::size_t>(c)];
    const Eigen::VectorXd rooted = cycle.root * direction;
    w.col(c) = cycle.share * rooted;
    d[c] = rooted.dot(w.col(c));
  }
  const Eigen::VectorXd squares = w.colwise().squaredNorm();
  const double trace = d.sum() - squares.sum();
  const double of_square = d.squaredNorm() - 2.0 * d.dot(squares) + gram(w.transpose()).squaredNorm();
  return of_square > 0.0 ? std::max(1.0, trace * trace / of_square) : 1.0;
}

}  // namespace

ByCycles covariance_by_cycles(const Linearisation& linearisation, const Eigen::MatrixXd& basis) {
  std::vector<OneCycle> cycles;
  Index begin = 0;
  for (const std::size_t end : linearisation.cycle_ends) {
    const Index count = static_cast<Index>(end) - begin;
    cycles.push_back(cycle_of(linearisation, begin, count, basis));
    begin = static_cast<Index>(end);
  }
  Eigen::MatrixXd scores(basis.cols(), static_cast<Index>(cycles.size()));
  for (Index c = 0; c < scores.cols(); ++c) scores.col(c) = cycles[static_cast<std::size_t>(c)].score;
  const Eigen::MatrixXd moved = basis * scores;
  ByCycles result{.covariance = moved * moved.transpose(), .degrees_of_freedom = {}};
  for (Index k = 0; k < basis.rows(); ++k) {
    const double length = basis.row(k).norm();
    result.degrees_of_freedom.push_back(
        length > 0.0 ? degrees_of_freedom(cycles, basis.row(k).transpose() / length) : 1.0);
  }
  return result;
}

}  // namespace kerf::fitting
