#include "poses/turns.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <fmt/core.h>

namespace kerf::bench {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double largest_fault = 1e-3;

Quaterniond quaternion_of(const std::string& order, std::span<const double> q) {
  return order == "wxyz" ? Quaterniond(q[0], q[1], q[2], q[3]) : Quaterniond(q[3], q[0], q[1], q[2]);
}

Matrix3d matrix_of(const std::string& order, std::span<const double> m) {
  const Matrix3d by_columns = Eigen::Map<const Matrix3d>(m.data());
  if (order == "columns") return by_columns;
  return by_columns.transpose();
}

Quaterniond turn_of_vector(const Vector3d& r) {
  const double angle = r.norm();
  if (angle == 0.0) return Quaterniond::Identity();
  return Quaterniond(AngleAxisd(angle, r / angle));
}

Quaterniond turn_of_angles(const std::string& order, std::span<const double> angles) {
  Quaterniond turn = Quaterniond::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto letter = static_cast<unsigned char>(order[i]);
    const bool turns_along = std::isupper(letter) != 0;
    const Quaterniond one(AngleAxisd(angles[i], Vector3d::Unit(std::tolower(letter) - 'x')));
    turn = turns_along ? turn * one : one * turn;
  }
  return turn;
}

/// The rotation nearest to a matrix that is almost one, by Newton's iteration for the polar decomposition.
Quaterniond nearest_turn(Matrix3d m) {
  constexpr int steps = 4;  // an error of 1e-3 goes to its square in each
  for (int i = 0; i < steps; ++i) m = 0.5 * (m + m.inverse().transpose()).eval();
  return Quaterniond(m);
}

Quaterniond turn_as_written(const OrientationForm& form, std::span<const double> values) {
  if (std::ranges::any_of(values, [](double v) { return std::isnan(v); }))
    return Quaterniond(Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN()));
  switch (form.kind) {
    case OrientationForm::Kind::quaternion:
      return quaternion_of(form.order, values).normalized();
    case OrientationForm::Kind::rotation_vector:
      return turn_of_vector(Vector3d(values[0], values[1], values[2]));
    case OrientationForm::Kind::euler:
      return turn_of_angles(form.order, values).normalized();
    case OrientationForm::Kind::matrix:
      return nearest_turn(matrix_of(form.order, values)).normalized();
  }
  return Quaterniond::Identity();
}

}  // namespace

std::string fault_of(const OrientationForm& form, std::span<const double> values) {
  if (std::ranges::any_of(values, [](double v) { return std::isnan(v); })) return {};
  if (form.kind == OrientationForm::Kind::quaternion) {
    const double norm = quaternion_of(form.order, values).norm();
    if (std::abs(norm - 1.0) <= largest_fault) return {};
    return fmt::format("are no quaternion of a rotation: their norm is {:.6g}, expected 1 within {:g}", norm,
                       largest_fault);
  }
  if (form.kind != OrientationForm::Kind::matrix) return {};
  const Matrix3d m = matrix_of(form.order, values);
  const double off = (m.transpose() * m - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= largest_fault))
    return fmt::format("are no rotation: their matrix R has R'R - 1 up to {:.3g}, expected {:g} at most", off,
                       largest_fault);
  return m.determinant() > 0.0 ? std::string() : "are a mirror and no rotation: their determinant is -1";
}

Quaterniond turn_of(const OrientationForm& form, std::span<const double> values) {
  const Quaterniond turn = turn_as_written(form, values);
  return form.is_inverse ? turn.conjugate() : turn;
}

Vector3d RotationPath::next(const Quaterniond& turn) {
  if (!turn.coeffs().allFinite()) return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  constexpr double whole = 2.0 * std::numbers::pi;
  const double sign = turn.w() < 0.0 ? -1.0 : 1.0;
  const double sine = turn.vec().norm();
  const double angle = 2.0 * std::atan2(sine, sign * turn.w());
  const double length = last_.norm();
  Vector3d axis = Vector3d::Zero();
  if (sine > 0.0) {
    axis = sign / sine * turn.vec();
  } else if (length > 0.0) {
    axis = last_ / length;
  }
  const double turns = std::floor((last_.dot(axis) - angle) / whole + 0.5);
  last_ = (angle + whole * turns) * axis;
  return last_;
}

}  // namespace kerf::bench
