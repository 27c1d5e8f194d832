#include "kerf/mechanisms/pantograph.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace kerf::mechanisms {
namespace {

using Vector = Pantograph::Vector;

Vector along(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }
Vector across(double angle_rad) { return {-std::sin(angle_rad), std::cos(angle_rad)}; }

/// The angle of an arm of that length, from its joint, whose forearm reaches a place; `side` 1: bent to the
/// left of the line to there, -1: to the right. Not a number for a place out of reach.
double angle_towards(const Vector& way, double arm, double forearm, double side) {
  const double distance = way.norm();
  const double bend =
      std::acos((arm * arm + distance * distance - forearm * forearm) / (2.0 * arm * distance));
  return std::atan2(way.y(), way.x()) + side * bend;
}

}  // namespace

Pantograph::Elbows Pantograph::elbows(const Vector& angles_rad) const noexcept {
  return {.first = made_.arm_m * along(angles_rad[0]),
          .second = Vector(made_.between_m, 0.0) + made_.arm_m * along(angles_rad[1])};
}

Vector Pantograph::handle(const Vector& angles_rad) const noexcept {
  const auto [a, b] = elbows(angles_rad);
  const Vector half = 0.5 * (b - a);
  const double height = std::sqrt(made_.forearm_m * made_.forearm_m - half.squaredNorm());
  // Of the two places where the forearms meet the one with the larger y.
  Vector up(-half.y(), half.x());
  if (up.y() < 0.0) up = -up;
  return a + half + height * up.normalized();
}

Pantograph::Matrix Pantograph::jacobian(const Vector& angles_rad) const noexcept {
  const auto [a, b] = elbows(angles_rad);
  const Vector e = handle(angles_rad);
  Matrix forearms;
  forearms << (e - a).transpose(), (e - b).transpose();
  if (!forearms.allFinite() || std::abs(forearms.determinant()) < 1e-9) {
    return Matrix::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const Matrix moved = Vector((e - a).dot(made_.arm_m * across(angles_rad[0])),
                              (e - b).dot(made_.arm_m * across(angles_rad[1])))
                           .asDiagonal();
  return forearms.inverse() * moved;
}

std::optional<Vector> Pantograph::angles_of(const Vector& handle_m) const noexcept {
  const Vector angles(
      angle_towards(handle_m, made_.arm_m, made_.forearm_m, 1.0),
      angle_towards(handle_m - Vector(made_.between_m, 0.0), made_.arm_m, made_.forearm_m, -1.0));
  return angles.allFinite() ? std::optional(angles) : std::nullopt;
}

}  // namespace kerf::mechanisms
