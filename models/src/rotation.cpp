#include "kerf/models/rotation.h"

#include <cmath>

#include <Eigen/Geometry>

namespace kerf::models {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) noexcept {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// sin(a)/a, (1 - cos a)/a^2 and (a - sin a)/a^3, by their series where the quotients lose digits.
struct Factors {
  double first, second, third;
};
Factors factors(double square) noexcept {
  if (square < 1e-4) {
    return {1.0 - square / 6.0 * (1.0 - square / 20.0), 0.5 - square / 24.0 * (1.0 - square / 30.0),
            1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0)};
  }
  const double angle = std::sqrt(square);
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  return {sine / angle, (1.0 - cosine) / square, (angle - sine) / (square * angle)};
}

}  // namespace

Matrix3d rotation_of(const Vector3d& rotation_vector) noexcept {
  const auto [first, second, third] = factors(rotation_vector.squaredNorm());
  const Matrix3d k = cross_matrix(rotation_vector);
  return Matrix3d::Identity() + first * k + second * k * k;
}

Matrix3d left_jacobian(const Vector3d& rotation_vector) noexcept {
  const auto [first, second, third] = factors(rotation_vector.squaredNorm());
  const Matrix3d k = cross_matrix(rotation_vector);
  return Matrix3d::Identity() + second * k + third * k * k;
}

Vector3d rotation_vector_of(const Matrix3d& rotation) noexcept {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace kerf::models
