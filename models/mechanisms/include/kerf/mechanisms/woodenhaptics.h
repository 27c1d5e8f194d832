#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

namespace kerf::mechanisms {

/// WoodenHaptics and its relatives: three joints, each driven by a capstan.
///
/// Frame: x towards the user, y to the right, z up, metres, with the origin where the makers have it. An arm
/// in a vertical plane that turns by A about z reaches `out` from that axis and `up`:
///
///     x = out cos A - ox,   y = out sin A - oy,   z = up - oz
///
/// In series (all but the Polhem), with B and C the angles of the two bodies from the vertical:
///
///     out = Lb sin B + Lc sin C,   up = Ln + Lb cos B - Lc cos C
///
/// As a closed linkage (Polhem): an upper arm Lb at B and a crank L2 at C, both from the horizontal, turn on
/// the base at K0 = (L0/2, 0) and Q0 = (-L0/2, 0). The forearm hangs on the upper arm's end K, at the angle
/// lambda; the tip is Lc before K on it, and L4 behind K a coupler L3 joins it to the crank's end Q:
///
///     K = K0 + Lb e(B),   Q = Q0 + L2 e(C),   |K - L4 e(lambda) - Q| = L3,   e(a) = (cos a, sin a)
///     (out, up) = K + Lc e(lambda)
///
/// Of the two ways to close it the forearm has the one in which the joint of the coupler lies to the left of
/// the line from K to Q.
///
/// An angle is the one at home, where the counters are zero, and the encoder's turn by the ratio of the
/// capstan's diameter to the body's; the current of a motor for a force F is its part of J^T F by that ratio
/// over the torque constant. In which direction encoders count and motors turn is a matter of wiring and
/// firmware, and of nothing here: whoever speaks for a device brings its Signs.
///
/// Source: facts of woody-experimental (2019) and haptikfabrikenapi (2021); the linkage's lengths and which
/// of them joins which, hfabapi (2026).
class WoodenHaptics {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  /// The parts of a closed linkage that an arm in series has not.
  struct Linkage {
    double base_m;     ///< L0
    double crank_m;    ///< L2
    double coupler_m;  ///< L3
    double tail_m;     ///< L4
  };

  /// Dimensions of one model. The arrays go by joint: A, B, C.
  struct Configuration {
    std::string_view name;
    std::array<double, 3> capstan_m{};        ///< diameters
    std::array<double, 3> body_m{};           ///< diameters
    std::array<double, 3> length_m{};         ///< Ln, Lb, Lc; a linkage has no Ln
    std::array<double, 3> origin_m{};         ///< ox, oy, oz
    std::array<double, 3> torque_constant{};  ///< [N·m/A]
    double max_current_a = 0.0;
    double counts_per_turn = 0.0;
    double max_force_n = 0.0;
    double max_stiffness_n_per_m = 0.0;
    std::array<double, 3> home_rad{};     ///< A, B, C where the counters are zero
    std::optional<Linkage> linkage = {};  ///< nothing: in series
    Vector centre_m = Vector::Zero();     ///< of the workspace
  };
  /// woody-2016, woody-2019, aluhaptics and polhem-v3.
  [[nodiscard]] static std::span<const Configuration> configurations() noexcept;
  [[nodiscard]] static const Configuration* find(std::string_view name) noexcept;

  /// Of each joint, 1 or -1: whether the counter grows with the angle, and whether a positive current turns
  /// the body towards greater angles.
  struct Signs {
    std::array<double, 3> encoder{1.0, 1.0, 1.0};
    std::array<double, 3> motor{1.0, 1.0, 1.0};
  };

  WoodenHaptics(const Configuration& configuration, const Signs& signs)
      : made_(configuration), signs_(signs) {}

  [[nodiscard]] const Configuration& configuration() const noexcept { return made_; }
  /// A, B, C [rad] from the counts of the three encoders.
  [[nodiscard]] Vector angles(const std::array<int, 3>& counts) const noexcept;
  /// The counts of the three encoders at these angles: angles() backwards, not rounded, each within half a
  /// turn of its body from home.
  [[nodiscard]] std::array<double, 3> counts(const Vector& angles_rad) const noexcept;
  /// Not finite where a linkage cannot be closed.
  [[nodiscard]] Vector tip(const Vector& angles_rad) const noexcept;
  [[nodiscard]] Vector home() const noexcept { return tip(Vector(made_.home_rad.data())); }
  /// The angles that put the tip there, the arm bent as at home; nothing for a place out of reach. The
  /// lengths Lb and Lc are two sides of a triangle whose third is the tip's distance from the upper arm's
  /// pivot; the crank's end is where circles of L2 and L3 meet.
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
  using Planar = Eigen::Vector2d;  ///< out, up
  struct Arm {
    Planar tip;
    Planar by_b;  ///< its derivative by B
    Planar by_c;
  };
  [[nodiscard]] Arm arm_in_series(double b_rad, double c_rad) const noexcept;
  [[nodiscard]] Arm arm_as_linkage(const Linkage& linkage, double b_rad, double c_rad) const noexcept;
  [[nodiscard]] Arm arm(double b_rad, double c_rad) const noexcept;

  Configuration made_;
  Signs signs_;
};

}  // namespace kerf::mechanisms
