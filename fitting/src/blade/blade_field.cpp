#include "blade/blade_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "infinite.h"
#include "least_squares.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double huber = 1.345;  // 95 % efficient on normal noise
constexpr int robust_passes = 30;
constexpr int weighting_passes = 3;
constexpr double no_information = 1e-10;  // of the largest, once the columns have one length
constexpr std::size_t stretch_count = 20;

struct Normal {
  Matrix3d matrix = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
};

/// Median of the sizes of one axis' residuals as a standard deviation, or their root mean square.
double deviation_of(const std::vector<Vector6d>& residuals, Eigen::Index axis, bool robust) {
  if (!robust) {
    double squares = 0.0;
    for (const Vector6d& r : residuals) squares += r[axis] * r[axis];
    return std::sqrt(squares / static_cast<double>(residuals.size()));
  }
  std::vector<double> sizes;
  for (const Vector6d& r : residuals) sizes.push_back(std::abs(r[axis]));
  return robust_deviation(std::move(sizes));
}

/// The noise of each axis: that given, else from residuals, and never so small against the force that
/// rounding would decide the weights. A torque of rounding errors is told by a lever of a centimetre.
Vector6d deviations(const FieldRows& rows, const std::vector<Vector6d>& residuals,
                    const BladeFitOptions& options) {
  constexpr double rounding = 1e-12;
  constexpr double lever_m = 0.01;
  double largest_n = 0.0;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    if (std::isinf(options.noise[static_cast<std::size_t>(axis)])) continue;
    largest_n =
        std::max(largest_n, deviation_of(rows.force, axis, false) / (axis < 3 ? 1.0 : 10.0 * lever_m));
  }
  Vector6d all;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double given = options.noise[static_cast<std::size_t>(axis)];
    const double least = rounding * largest_n * (axis < 3 ? 1.0 : lever_m);
    const double estimated = std::max(deviation_of(residuals, axis, options.robust), least);
    all[axis] = given > 0.0 ? given : estimated > 0.0 ? estimated : infinite;
  }
  return all.array().isInf().all() ? Vector6d::Ones().eval() : all;
}

Vector6d row_weights(const Vector6d& residual, const Vector6d& deviation, bool robust) {
  Vector6d weights = deviation.cwiseAbs2().cwiseInverse();
  if (!robust) return weights;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double size = std::abs(residual[axis]) / deviation[axis];
    if (size > huber) weights[axis] *= huber / size;
  }
  return weights;
}

Normal normal_of(const FieldRows& rows, const std::vector<Vector6d>& residuals, const Vector6d& deviation,
                 bool robust) {
  Normal normal;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Vector6d weights = row_weights(residuals[i], deviation, robust);
    const Columns weighted = weights.asDiagonal() * rows.columns[i];
    normal.matrix.noalias() += rows.columns[i].transpose() * weighted;
    normal.right.noalias() += weighted.transpose() * rows.force[i];
  }
  return normal;
}

/// Least squares with no coefficient below zero: of the eight sets of free ones the best that is feasible.
Vector3d solve_not_negative(const Normal& normal, const std::array<bool, 3>& absent) {
  Vector3d best = Vector3d::Zero();
  double least = 0.0;
  for (unsigned set = 1; set < 8; ++set) {
    std::vector<Eigen::Index> free;
    for (unsigned k = 0; k < 3; ++k) {
      if ((set >> k & 1U) != 0U && !absent[k]) free.push_back(static_cast<Eigen::Index>(k));
    }
    if (free.empty()) continue;
    const Vector3d length = normal.matrix.diagonal().cwiseSqrt();
    Eigen::MatrixXd part(free.size(), free.size());
    Eigen::VectorXd right(free.size());
    for (Eigen::Index a = 0; a < part.rows(); ++a) {
      const auto at = free[static_cast<std::size_t>(a)];
      right[a] = normal.right[at] / length[at];
      for (Eigen::Index b = 0; b < part.rows(); ++b) {
        const auto to = free[static_cast<std::size_t>(b)];
        part(a, b) = normal.matrix(at, to) / (length[at] * length[to]);
      }
    }
    const Eigen::VectorXd scaled = solve_normal(part, right);
    if (!(scaled.minCoeff() >= 0.0)) continue;
    const double cost = scaled.dot(part * scaled) - 2.0 * scaled.dot(right);
    if (cost >= least) continue;
    least = cost;
    best.setZero();
    for (Eigen::Index a = 0; a < scaled.size(); ++a) {
      const auto at = free[static_cast<std::size_t>(a)];
      best[at] = scaled[a] / length[at];
    }
  }
  return best;
}

std::vector<Vector6d> residuals_of(const FieldRows& rows, const Vector3d& value) {
  std::vector<Vector6d> residuals;
  residuals.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) residuals.push_back(rows.force[i] - rows.columns[i] * value);
  return residuals;
}

/// An edge counts by metres and a surface by square metres: only orders of magnitude beyond those are
/// nothing.
std::array<bool, 3> absent_columns(const Normal& normal) {
  const Vector3d squares = normal.matrix.diagonal();
  std::array<bool, 3> absent{};
  for (Eigen::Index k = 0; k < 3; ++k) {
    absent[static_cast<std::size_t>(k)] = !(squares[k] > 1e-18 * squares.maxCoeff());
  }
  return absent;
}

/// The inverse where there is one, and which coefficients have none.
Matrix3d inverse_of(const Matrix3d& normal, const std::array<bool, 3>& absent,
                    std::array<bool, 3>& undetermined) {
  Vector3d scale = Vector3d::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (!absent[static_cast<std::size_t>(k)]) scale[k] = 1.0 / std::sqrt(normal(k, k));
  }
  const Matrix3d scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(scaled);
  Matrix3d inverse = Matrix3d::Zero();
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Vector3d direction = solver.eigenvectors().col(j);
    if (solver.eigenvalues()[j] > no_information) {
      inverse += direction * direction.transpose() / solver.eigenvalues()[j];
      continue;
    }
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (std::abs(direction[k]) > 1e-3) undetermined[static_cast<std::size_t>(k)] = true;
    }
  }
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

/// Deviations by leaving out one stretch of time after another, one Newton step for each.
Vector3d jackknife(const FieldRows& rows, const FieldFit& fit, const Matrix3d& whole, bool robust) {
  std::array<Normal, stretch_count> stretch;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Normal& part = stretch[i * stretch_count / rows.size()];
    const Columns weighted =
        row_weights(fit.residuals[i], fit.deviation, robust).asDiagonal() * rows.columns[i];
    part.matrix.noalias() += rows.columns[i].transpose() * weighted;
    part.right.noalias() += weighted.transpose() * fit.residuals[i];
  }
  Vector3d squares = Vector3d::Zero();
  for (const Normal& part : stretch) {
    std::array<bool, 3> ignored{};
    squares += (inverse_of(whole - part.matrix, fit.absent, ignored) * part.right).cwiseAbs2();
  }
  constexpr double groups = stretch_count;
  return ((groups - 1.0) / groups * squares).cwiseSqrt();
}

/// Everything about uncertainty: standard errors, intervals, correlation.
void find_intervals(FieldFit& fit, const FieldRows& rows, const Matrix3d& normal,
                    const BladeFitOptions& options) {
  const Matrix3d inverse = inverse_of(normal, fit.absent, fit.undetermined);
  Matrix3d middle = Matrix3d::Zero();
  double effective = 0.0;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    if (std::isinf(fit.deviation[axis])) continue;
    std::vector<double> residuals;
    Matrix3d scores = Matrix3d::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Vector6d weights = row_weights(fit.residuals[i], fit.deviation, options.robust);
      residuals.push_back(weights[axis] * fit.residuals[i][axis]);
      const Vector3d column = rows.columns[i].row(axis).transpose();
      scores.noalias() += residuals.back() * residuals.back() * column * column.transpose();
    }
    fit.correlation_time[axis] = correlation_time(residuals);
    middle += fit.correlation_time[axis] * scores;
    effective += static_cast<double>(rows.size()) / fit.correlation_time[axis];
  }
  const Matrix3d covariance = inverse * middle * inverse;
  const Vector3d by_groups = jackknife(rows, fit, normal, options.robust);
  const double t_of_samples = student_t(options.confidence, effective - 3.0);
  const double t_of_groups = student_t(options.confidence, static_cast<double>(stretch_count) - 1.0);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double by_samples = std::sqrt(covariance(k, k));
    const bool none = fit.undetermined[static_cast<std::size_t>(k)];
    fit.std_error[k] = none ? infinite : std::max(by_samples, by_groups[k]);
    const double reach = none                         ? infinite
                         : by_samples >= by_groups[k] ? t_of_samples * by_samples
                                                      : t_of_groups * by_groups[k];
    fit.lower[k] = none ? 0.0 : std::max(0.0, fit.value[k] - reach);
    fit.upper[k] = fit.value[k] + reach;
    for (Eigen::Index j = 0; j < 3; ++j) {
      const bool either = none || fit.undetermined[static_cast<std::size_t>(j)];
      fit.correlation(k, j) = either   ? std::numeric_limits<double>::quiet_NaN()
                              : j == k ? 1.0
                                       : inverse(k, j) / std::sqrt(inverse(k, k) * inverse(j, j));
    }
  }
}

}  // namespace

FieldFit fit_field(const FieldRows& rows, const BladeFitOptions& options) {
  FieldFit fit;
  fit.residuals = rows.force;  // the first pass weights each axis by its force
  if (rows.size() == 0) {
    fit.absent = fit.undetermined = {true, true, true};
    fit.std_error.setConstant(infinite);
    fit.upper.setConstant(infinite);
    fit.correlation.setConstant(std::numeric_limits<double>::quiet_NaN());
    return fit;
  }
  Normal normal;
  const int passes = options.robust ? robust_passes : weighting_passes;
  for (int pass = 0; pass <= passes; ++pass) {
    const bool robust = options.robust && pass > 0;
    fit.deviation = deviations(rows, fit.residuals, options);
    normal = normal_of(rows, fit.residuals, fit.deviation, robust);
    fit.absent = absent_columns(normal);
    fit.value = solve_not_negative(normal, fit.absent);
    fit.residuals = residuals_of(rows, fit.value);
  }
  fit.undetermined = fit.absent;
  find_intervals(fit, rows, normal.matrix, options);
  return fit;
}

}  // namespace kerf::fitting
