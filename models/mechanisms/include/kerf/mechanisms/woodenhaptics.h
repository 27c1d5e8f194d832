#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

namespace kerf::mechanisms {

/// WoodenHaptics and its relatives: three joints in series, each driven by a capstan.
///
/// Frame: x towards the user, y to the right, z up, metres. With A the turn of the base and B, C the angles
/// of the two bodies,
///
///     x = cos A (Lb sin B + Lc sin C) - ox,   y = sin A (Lb sin B + Lc sin C) - oy,
///     z = Ln + Lb cos B - Lc cos C - oz
///
/// An angle is the encoder's turn by the ratio of the capstan's diameter to the body's; the current of a
/// motor for a force F is its part of J^T F by that ratio over the torque constant. Signs are those of the
/// makers' CHAI3D driver: at zero counts A = 0, B = 0, C = pi/2.
///
/// Source: facts of woody-experimental (2019) and haptikfabrikenapi (2021).
class WoodenHaptics {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  /// Dimensions of one model. The arrays go by joint: A, B, C.
  struct Configuration {
    std::string_view name;
    std::array<double, 3> capstan_m;        ///< diameters
    std::array<double, 3> body_m;           ///< diameters
    std::array<double, 3> length_m;         ///< Ln, Lb, Lc
    std::array<double, 3> origin_m;         ///< ox, oy, oz
    std::array<double, 3> torque_constant;  ///< [N·m/A]
    double max_current_a;
    double counts_per_turn;
    double max_force_n;
    double max_stiffness_n_per_m;
  };
  /// woody-2016, woody-2019, aluhaptics and polhem-v3.
  [[nodiscard]] static std::span<const Configuration> configurations() noexcept;
  [[nodiscard]] static const Configuration* find(std::string_view name) noexcept;

  explicit WoodenHaptics(const Configuration& configuration) : made_(configuration) {}

  [[nodiscard]] const Configuration& configuration() const noexcept { return made_; }
  /// A, B, C [rad] from the counts of the three encoders.
  [[nodiscard]] Vector angles(const std::array<int, 3>& counts) const noexcept;
  /// The counts of the three encoders at these angles: angles() backwards, not rounded.
  [[nodiscard]] std::array<double, 3> counts(const Vector& angles_rad) const noexcept;
  [[nodiscard]] Vector tip(const Vector& angles_rad) const noexcept;
  /// The angles that put the tip there, the second body bent as at home (B < pi - C); nothing for a place out
  /// of reach. With r and h the tip's distance from the axis of A and its height above that of B, the lengths
  /// Lb and Lc are two sides of a triangle whose third is sqrt(r^2 + h^2).
  [[nodiscard]] std::optional<Vector> angles_of(const Vector& tip_m) const noexcept;
  /// d tip / d(A, B, C) [m/rad].
  [[nodiscard]] Matrix jacobian(const Vector& angles_rad) const noexcept;

  struct Currents {
    std::array<double, 3> ampere{};
    bool limited = false;
  };
  /// Currents for a force of the tip [N], all scaled alike if one exceeds what the motors bear, so that the
  /// force keeps its direction. Zero for a force that is not finite.
  [[nodiscard]] Currents currents(const Vector& force_n, const Vector& angles_rad) const noexcept;
  /// The force at the tip [N] that currents of the three motors [A] make: currents() backwards, without its
  /// limit. Not finite where an arm is stretched out, because there a direction bears any force.
  [[nodiscard]] Vector force(const std::array<double, 3>& ampere, const Vector& angles_rad) const noexcept;

 private:
  Configuration made_;
};

}  // namespace kerf::mechanisms
