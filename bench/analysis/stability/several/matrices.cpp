#include "stability/several/matrices.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace kerf::bench {
namespace {

using Eigen::MatrixXd;
using SymmetricSolver = Eigen::SelfAdjointEigenSolver<MatrixXd>;

/// A symmetric matrix of its eigenvectors and other eigenvalues.
MatrixXd recomposed(const SymmetricSolver& solver, const Eigen::VectorXd& values) {
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

MatrixXd root(const MatrixXd& symmetric) {
  const SymmetricSolver solver(symmetric);
  return recomposed(solver, solver.eigenvalues().cwiseMax(0.0).cwiseSqrt());
}

}  // namespace

double largest_modulus(const MatrixXd& matrix) {
  return Eigen::EigenSolver<MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

double least_eigenvalue(const MatrixXd& symmetric) {
  return SymmetricSolver(symmetric).eigenvalues().minCoeff();
}

double largest_singular_value(const MatrixXd& matrix) {
  return std::sqrt(std::max(0.0, SymmetricSolver(matrix.transpose() * matrix).eigenvalues().maxCoeff()));
}

MatrixXd inverse_root(const MatrixXd& symmetric) {
  const SymmetricSolver solver(symmetric);
  return recomposed(solver, solver.eigenvalues().cwiseSqrt().cwiseInverse());
}

MatrixXd positive_part(const MatrixXd& symmetric) {
  const SymmetricSolver solver(symmetric);
  return recomposed(solver, solver.eigenvalues().cwiseMax(0.0));
}

MatrixXd mean_modulus(const MatrixXd& matrix) {
  return 0.5 * (root(matrix.transpose() * matrix) + root(matrix * matrix.transpose()));
}

MatrixXd exponential(const MatrixXd& matrix) {
  constexpr int terms = 12;
  const double norm = matrix.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = norm > 0.0 ? std::max(0, std::ilogb(norm) + 6) : 0;
  const MatrixXd part = std::ldexp(1.0, -squarings) * matrix;
  MatrixXd sum = MatrixXd::Identity(matrix.rows(), matrix.cols());
  MatrixXd term = sum;
  for (int order = 1; order <= terms; ++order) {
    term = (term * part / order).eval();
    sum += term;
  }
  for (int i = 0; i < squarings; ++i) sum = (sum * sum).eval();
  return sum;
}

MatrixXd divided_by(const MatrixXd& mass, const MatrixXd& matrix) { return mass.llt().solve(matrix); }

}  // namespace kerf::bench
