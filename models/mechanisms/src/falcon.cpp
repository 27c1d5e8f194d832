#include "kerf/mechanisms/falcon.h"

#include <cmath>

#include <Eigen/LU>

#include "kerf/mechanisms/angle.h"

namespace kerf::mechanisms {
namespace {

constexpr std::array<double, 3> phi{105.0 * degree, -15.0 * degree, -135.0 * degree};
// Lengths [m], by the letters of the header.
constexpr double a = 0.060;
constexpr double b = 0.1025;
constexpr double c = 0.01443;
constexpr double d = 0.01125;
constexpr double e = 0.01125;
constexpr double f = -0.025;
constexpr double r = 0.0400;
constexpr double s = -0.02309;

constexpr int max_steps = 30;
constexpr double close_enough_rad = 1e-12;

/// Angles of one leg; false where it does not reach.
bool leg(std::size_t i, const Eigen::Vector3d& p, double& shoulder, double& pitch, double& yaw) noexcept {
  const double along = std::cos(phi[i]) * p.x() + std::sin(phi[i]) * p.y() - r;
  const double across = -std::sin(phi[i]) * p.x() + std::cos(phi[i]) * p.y() - s;
  const double cosine = (across + f) / b;
  if (!(std::abs(cosine) < 1.0)) return false;
  yaw = std::acos(cosine);
  const double length = d + e + b * std::sin(yaw);
  const double x = along + c;
  const double z = p.z();
  const double k = (x * x + z * z + a * a - length * length) / (2.0 * a);
  const double square = x * x + z * z - k * k;
  if (!(square >= 0.0)) return false;
  shoulder = 2.0 * std::atan((k - x) / (z + std::sqrt(square)));  // (z - sqrt) / (k + x), without its poles
  pitch = std::atan2(z - a * std::sin(shoulder), x - a * std::cos(shoulder));
  return std::isfinite(shoulder) && std::isfinite(pitch);
}

}  // namespace

std::optional<Falcon::Angles> Falcon::angles(const Vector& knob) noexcept {
  Angles at;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (!leg(i, knob, at.shoulder[k], at.pitch[k], at.yaw[k])) return std::nullopt;
  }
  return at;
}

Falcon::Matrix Falcon::angle_rates(const Angles& at) noexcept {
  Matrix rates;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double sine = std::sin(at.yaw[k]);
    const double radial = std::cos(at.pitch[k]) * sine;
    const double lateral = std::cos(at.yaw[k]);
    rates.row(k) << std::cos(phi[i]) * radial - std::sin(phi[i]) * lateral,
        std::sin(phi[i]) * radial + std::cos(phi[i]) * lateral, std::sin(at.pitch[k]) * sine;
    rates.row(k) /= a * sine * std::sin(at.pitch[k] - at.shoulder[k]);
  }
  return rates;
}

std::optional<Falcon::Vector> Falcon::knob(const Vector& shoulder_rad, const Vector& nearby) noexcept {
  Vector p = nearby;
  for (int step = 0; step < max_steps; ++step) {
    const auto at = angles(p);
    if (!at) return std::nullopt;
    const Vector error = shoulder_rad - at->shoulder;
    if (error.cwiseAbs().maxCoeff() < close_enough_rad) return p;
    Vector move = angle_rates(*at).inverse() * error;
    // Half of a step that would leave the workspace, again and again.
    for (int half = 0; half < max_steps && !angles(p + move); ++half) move *= 0.5;
    p += move;
  }
  return std::nullopt;
}

Falcon::Vector Falcon::torques(const Vector& force_n, const Angles& at) noexcept {
  return angle_rates(at).transpose().inverse() * force_n;
}

Falcon::Vector Falcon::force(const Vector& torque_n_m, const Angles& at) noexcept {
  return angle_rates(at).transpose() * torque_n_m;
}

Falcon::Vector Falcon::shoulder_of(const std::array<int, 3>& counts) noexcept {
  const auto angle = [](int count) { return degree * (degrees_at_zero + degrees_per_count * count); };
  return {angle(counts[0]), angle(counts[1]), angle(counts[2])};
}

std::array<int, 3> Falcon::counts_of(const Vector& shoulder_rad) noexcept {
  const auto count = [](double angle) {
    return static_cast<int>(std::lround((angle / degree - degrees_at_zero) / degrees_per_count));
  };
  return {count(shoulder_rad[0]), count(shoulder_rad[1]), count(shoulder_rad[2])};
}

}  // namespace kerf::mechanisms
