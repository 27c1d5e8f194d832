#include "least_squares.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace kerf::fitting {

// With J'J = V L V', R is L^1/2 V' and Q'r is L^-1/2 V'J'r.
Triangle triangle_of(const Sums& sums) {
  const Eigen::VectorXd diagonal = sums.normal.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = (diagonal.array() > 0.0).select(diagonal.cwiseInverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(scale.asDiagonal() * sums.normal *
                                                                scale.asDiagonal());
  const Eigen::VectorXd root = spectrum.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const double least = 1e-8 * root.maxCoeff();  // below this the sums have no digits left
  const Eigen::VectorXd inverse = (root.array() > least).select(root.cwiseInverse(), 0.0);
  Triangle triangle;
  triangle.r = (inverse.array() > 0.0).select(root, 0.0).matrix().asDiagonal() *
               spectrum.eigenvectors().transpose() * diagonal.asDiagonal();
  triangle.z =
      inverse.asDiagonal() * (spectrum.eigenvectors().transpose() * (scale.asDiagonal() * sums.score));
  triangle.rest = std::sqrt(std::max(0.0, sums.squares - triangle.z.squaredNorm()));
  return triangle;
}

bool Objective::factor(const Eigen::VectorXd& at, Sums& sums, Triangle& triangle) const {
  if (!evaluate(at, sums) || !std::isfinite(sums.squares) || !sums.normal.allFinite()) return false;
  triangle = triangle_of(sums);
  return true;
}

bool DenseObjective::evaluate(const Eigen::VectorXd& at, Sums& sums) const {
  Triangle triangle;
  return factor(at, sums, triangle);
}

bool DenseObjective::factor(const Eigen::VectorXd& at, Sums& sums, Triangle& triangle) const {
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  if (!rows(at, residual, jacobian) || !residual.allFinite() || !jacobian.allFinite()) return false;
  sums.squares = residual.squaredNorm();
  sums.score = jacobian.transpose() * residual;
  sums.normal = jacobian.transpose() * jacobian;
  const Eigen::Index p = jacobian.cols();
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(std::max(jacobian.rows(), p + 1), p + 1);
  both.topLeftCorner(jacobian.rows(), p) = jacobian;
  both.col(p).head(jacobian.rows()) = residual;
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(both);
  const Eigen::MatrixXd r = factors.matrixQR().topRows(p + 1).triangularView<Eigen::Upper>();
  triangle = {.r = r.topLeftCorner(p, p), .z = r.col(p).head(p), .rest = std::abs(r(p, p))};
  return true;
}

Eigen::VectorXd shortest_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd norm = a.colwise().norm();
  const Eigen::VectorXd scale = (norm.array() > 0.0).select(norm.cwiseInverse(), 0.0);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors(a.rows(), a.cols());
  factors.setThreshold(1e-12);
  return scale.cwiseProduct(factors.compute(a * scale.asDiagonal()).solve(b));
}

Eigen::VectorXd solve_normal(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right) {
  return normal.completeOrthogonalDecomposition().solve(right);
}

std::optional<Eigen::VectorXd> solve_positive(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::LLT<Eigen::MatrixXd> factors(a);
  if (factors.info() != Eigen::Success) return std::nullopt;
  return factors.solve(b);
}

Eigen::VectorXd solve_bounded(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right,
                              const Bounds& bounds) {
  // Unbounded first: where it lies inside, there is nothing more to do.
  Eigen::VectorXd x = solve_normal(normal, right);
  const auto inside = [&] {
    return ((x.array() >= bounds.lower.array()) && (x.array() <= bounds.upper.array())).all();
  };
  if (x.allFinite() && inside()) return x;
  x = x.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  for (int round = 0; round < 2000; ++round) {
    double moved = 0.0;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      if (!(normal(k, k) > 0.0)) continue;
      const double free = x[k] + (right[k] - normal.row(k).dot(x)) / normal(k, k);
      const double next = std::clamp(free, bounds.lower[k], bounds.upper[k]);
      moved = std::max(moved, std::abs(next - x[k]) * std::sqrt(normal(k, k)));
      x[k] = next;
    }
    if (moved < 1e-12 * std::sqrt(std::max(right.dot(x), 0.0))) break;
  }
  return x;
}

}  // namespace kerf::fitting
