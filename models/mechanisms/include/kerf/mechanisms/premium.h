#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace kerf::mechanisms {

/// The Phantom Premium 1.5 of SensAble as rigid bodies: three joints, a tip that translates.
///
/// Frame: x to the right, y up, z towards the user, right-handed; the origin is where the tip stands at q =
/// 0. q1 turns the arm about the vertical. A parallelogram drives the arm within its plane, so that q2 is the
/// pitch of the upper arm (up from the horizontal) and q3 that of the forearm (outwards from hanging), both
/// against the ground and not against each other. With the radius r of the tip from the vertical axis
///
///     r   = l1 cos q2 + l2 sin q3
///     tip = (r sin q1, l1 sin q2 - l2 cos q3 + l2, r cos q1 - l1)
///
/// Motion: H(q) q'' + C(q, q') q' + g(q) = tau. The kinetic energy is the sum over the bodies, each in the
/// plane that q1 turns. A body whose mass centre lies `a` along the upper arm and `b` along the forearm moves
/// as 1/2 m [(a cos q2 + b sin q3)^2 q1'^2 + a^2 q2'^2 + b^2 q3'^2 + 2 a b sin(q3 - q2) q2' q3'] and turns
/// with one of the two arms, of which Ixx is the moment about the axis of pitch; in the frame of that arm the
/// vertical is cos q in y and sin q in z. The sum has the shape
///
///     H11 = base + Uy cos^2 q2 + Uz sin^2 q2 + Fy cos^2 q3 + Fz sin^2 q3 + 2 k cos q2 sin q3
///     H22, H33 constant,  H23 = k sin(q3 - q2),  H12 = H13 = 0
///
/// C is made of the Christoffel symbols of H, so that H' = C + C^T. Potential: g (Pu sin q2 - Pf cos q3).
///
/// Source: [Cavusoglu2002]. Values as
/// published; recalled from the paper's table, not re-checked. Bodies: a the forearm, c the rod that drives
/// it beside the upper arm, be and df what turns with upper arm and forearm about the shoulder, motors
/// included, g the base. Moments of a and c are about the mass centres, those of be and df about the
/// shoulder. The moments printed for be and df miss the triangle inequality (xx <= yy + zz) by 4 %; they are
/// taken as they are. An independent public model of the same arm, made from drawings, has masses 5 to 30 %
/// larger, lengths and the mass centres of be and df within 5 %, and the same gear ratios and rotors. Not in
/// the table, and added: the rotors, 1.08e-6 kg·m^2 each by the square of the gear ratio, 13.3, 11.2, 11.2;
/// and a payload (gimbal, tool), a point at the tip. The joints' ranges are assumed.
class Premium {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  struct Options {
    double payload_kg = 0.0;   ///< at the tip, >= 0
    bool with_gravity = true;  ///< off: as if balanced
  };
  struct Range {
    double lower;
    double upper;
  };
  /// All of it at one pose and speed, as a tick needs it.
  struct Dynamics {
    Matrix inertia;                ///< H [kg·m^2]
    Matrix coriolis;               ///< C [N·m·s/rad]
    Vector coriolis_torque;        ///< C q' [N·m]
    Vector gravity;                ///< g [N·m]
    Matrix jacobian;               ///< J, d tip / dq [m/rad]
    Vector jacobian_rate_times_v;  ///< J' q' [m/s^2]
    Vector tip;                    ///< [m]
  };

  static constexpr double upper_arm_m = 0.215;  ///< l1
  static constexpr double forearm_m = 0.170;    ///< l2
  static constexpr double gravity_m_s2 = 9.81;
  static constexpr std::array<double, 3> gear_ratio{13.3, 11.2, 11.2};
  static constexpr std::array<Range, 3> joint_range_rad{{{-0.9, 0.9}, {-0.6, 1.05}, {-0.7, 1.05}}};
  /// Of q3 - q2: towards +-90 deg the arm stretches or folds and the tip loses a direction.
  static constexpr Range fold_range_rad{-1.05, 1.05};

  /// @throws std::invalid_argument if the payload is negative or not finite.
  explicit Premium(const Options& options);
  Premium() : Premium(Options{}) {}

  [[nodiscard]] static Vector tip(const Vector& q) noexcept;
  [[nodiscard]] static Matrix jacobian(const Vector& q) noexcept;
  /// dJ/dt.
  [[nodiscard]] static Matrix jacobian_rate(const Vector& q, const Vector& qd) noexcept;
  /// The angles within the limits at which the tip is there; nothing if there are none.
  [[nodiscard]] static std::optional<Vector> joint_angles(const Vector& tip) noexcept;
  [[nodiscard]] static bool within_limits(const Vector& q) noexcept;

  [[nodiscard]] Matrix inertia(const Vector& q) const noexcept;
  [[nodiscard]] Matrix coriolis(const Vector& q, const Vector& qd) const noexcept;
  [[nodiscard]] Vector gravity(const Vector& q) const noexcept;
  [[nodiscard]] double kinetic_energy(const Vector& q, const Vector& qd) const noexcept;
  /// Zero at q = 0.
  [[nodiscard]] double potential_energy(const Vector& q) const noexcept;
  /// The functions above at the price of one set of sines and cosines, with the same values to the last bit.
  [[nodiscard]] Dynamics dynamics(const Vector& q, const Vector& qd) const noexcept;
  /// H^-1 (tau - C q' - g).
  [[nodiscard]] Vector acceleration(const Vector& q, const Vector& qd, const Vector& torque) const noexcept;

 private:
  struct Directions;
  static Vector tip(const Directions& at) noexcept;
  static Matrix jacobian(const Directions& at) noexcept;
  static Matrix jacobian_rate(const Directions& at, const Vector& qd) noexcept;
  Matrix inertia(const Directions& at) const noexcept;
  Matrix coriolis(const Directions& at, const Vector& qd) const noexcept;
  Vector gravity(const Directions& at) const noexcept;

  double base_;              ///< about the vertical, rotor 1 included [kg·m^2], as all up to k
  double upper_y_;           ///< Uy
  double upper_z_;           ///< Uz
  double fore_y_;            ///< Fy
  double fore_z_;            ///< Fz
  double upper_pitch_;       ///< H22
  double fore_pitch_;        ///< H33
  double coupling_;          ///< k
  double upper_weight_n_m_;  ///< g Pu
  double fore_weight_n_m_;   ///< g Pf
};

}  // namespace kerf::mechanisms
