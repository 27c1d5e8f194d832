#pragma once

#include <concepts>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kerf::models {

/// An object's surface phi(p) = 0, phi > 0 outside, with its gradient. Where a surface also knows how its
/// gradient changes along a motion, gradient_rate() is asked; else a central difference of the gradient
/// stands in for it.
template <typename S>
concept ImplicitSurface = requires(const S& surface, const Eigen::Vector3d& p) {
  { surface.phi(p) } -> std::convertible_to<double>;
  { surface.gradient(p) } -> std::convertible_to<Eigen::Vector3d>;
};

/// phi = n . (p - o), |n| = 1: the distance from a plane through o.
struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< o [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  ///< n

  [[nodiscard]] double phi(const Eigen::Vector3d& p) const noexcept { return normal.dot(p - point); }
  [[nodiscard]] Eigen::Vector3d gradient(const Eigen::Vector3d&) const noexcept { return normal; }
  [[nodiscard]] Eigen::Vector3d gradient_rate(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Vector3d::Zero();
  }
};

/// phi = |p - c| - R: the distance from a sphere. No gradient at its centre.
struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< c [m]
  double radius_m = 0.05;                            ///< R

  [[nodiscard]] double phi(const Eigen::Vector3d& p) const noexcept { return (p - centre).norm() - radius_m; }
  [[nodiscard]] Eigen::Vector3d gradient(const Eigen::Vector3d& p) const noexcept {
    const double distance = (p - centre).norm();
    return distance > 0.0 ? Eigen::Vector3d((p - centre) / distance) : Eigen::Vector3d::Zero();
  }
  [[nodiscard]] Eigen::Vector3d gradient_rate(const Eigen::Vector3d& p,
                                              const Eigen::Vector3d& v) const noexcept {
    const double distance = (p - centre).norm();
    if (!(distance > 0.0)) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d n = (p - centre) / distance;
    return (v - n.dot(v) * n) / distance;
  }
};

/// Any other surface, from two functions: phi(p) and its gradient.
template <typename Phi, typename Gradient>
struct SurfaceOf {
  Phi phi_of;
  Gradient gradient_of;

  [[nodiscard]] double phi(const Eigen::Vector3d& p) const { return phi_of(p); }
  [[nodiscard]] Eigen::Vector3d gradient(const Eigen::Vector3d& p) const { return gradient_of(p); }
};
template <typename Phi, typename Gradient>
SurfaceOf(Phi, Gradient) -> SurfaceOf<Phi, Gradient>;

/// d/dt of the gradient for a point that moves with v [1/s].
template <ImplicitSurface S>
[[nodiscard]] Eigen::Vector3d gradient_rate(const S& surface, const Eigen::Vector3d& p,
                                            const Eigen::Vector3d& v) {
  if constexpr (requires { surface.gradient_rate(p, v); }) {
    return surface.gradient_rate(p, v);
  } else {
    const double speed = v.norm();
    if (!(speed > 0.0)) return Eigen::Vector3d::Zero();
    constexpr double half_step_m = 1e-6;  // far below any curvature of an object, far above rounding
    const Eigen::Vector3d step = half_step_m / speed * v;
    const Eigen::Vector3d change = surface.gradient(p + step) - surface.gradient(p - step);
    return speed / (2.0 * half_step_m) * change;
  }
}

}  // namespace kerf::models
