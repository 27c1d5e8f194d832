#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace kerf::mechanisms {

/// The Novint Falcon as a delta robot: three arms, a knob that translates.
///
/// Frame: x right, y up, z out towards the user, metres, origin in the base. Each leg stands at phi = 105,
/// -15, -135 deg about z. For the knob at p, in the leg's own frame P = Rz(-phi) p - (r, s, 0):
///
///     theta3 = acos((Py + f) / b),   L = d + e + b sin(theta3),   X = Px + c,   Z = Pz
///     X cos(theta1) + Z sin(theta1) = (X^2 + Z^2 + a^2 - L^2) / (2 a)      the smaller root
///     theta2 = atan2(Z - a sin(theta1), X - a cos(theta1))
///
/// theta1 is the angle of the arm that the motor drives, theta2 and theta3 those of its parallelogram. A row
/// of d theta1 / dp, over a sin(theta3) sin(theta2 - theta1), is
///
///     (cos phi cos th2 sin th3 - sin phi cos th3,  sin phi cos th2 sin th3 + cos phi cos th3,  sin th2 sin
///     th3)
///
/// and a force F of the knob needs the torques tau = (d theta / dp)^-T F.
///
/// Source: [Tsai1999], [Stamper1997], with the dimensions and the encoder's scale that libnifalcon uses (BSD;
/// facts alone). The z column there has sin^2 th2 in place of sin th2 sin th3, and its matrix is transposed
/// onto itself: its forces point up to 49 deg away from those asked for. The angle at zero counts is disputed
/// (35, 40 or 50 deg).
class Falcon {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  static constexpr double degrees_per_count = 0.0364347;  ///< of an arm: 1280 counts a motor turn, gain 7.719
  static constexpr double degrees_at_zero = 35.0;

  /// Angles of every leg at one place of the knob [rad].
  struct Angles {
    Vector shoulder;  ///< theta1
    Vector pitch;     ///< theta2
    Vector yaw;       ///< theta3
  };

  /// Nothing where the knob cannot be.
  [[nodiscard]] static std::optional<Angles> angles(const Vector& knob) noexcept;

  /// d theta1 / dp [rad/m].
  [[nodiscard]] static Matrix angle_rates(const Angles& at) noexcept;

  /// Where the knob is for three arm angles, by Newton's method from a place nearby; nothing if it does not
  /// get there.
  [[nodiscard]] static std::optional<Vector> knob(const Vector& shoulder_rad, const Vector& nearby) noexcept;

  /// Torques of the arms for a force of the knob [N·m].
  [[nodiscard]] static Vector torques(const Vector& force_n, const Angles& at) noexcept;
  /// The force of the knob for torques of the arms [N].
  [[nodiscard]] static Vector force(const Vector& torque_n_m, const Angles& at) noexcept;

  [[nodiscard]] static Vector shoulder_of(const std::array<int, 3>& counts) noexcept;
  [[nodiscard]] static std::array<int, 3> counts_of(const Vector& shoulder_rad) noexcept;
};

}  // namespace kerf::mechanisms
