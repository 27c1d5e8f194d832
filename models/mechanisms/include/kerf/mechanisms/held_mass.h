#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace kerf::mechanisms {

/// Where an axis is and how fast it moves.
struct AxisMotion {
  double position_m = 0.0;
  double speed_m_s = 0.0;
};

/// A mass on a spring and a damper, with Coulomb friction that may be another one in each direction:
///
///     m x'' = F - c x' - k x - f_c sign(x'),   f_c = coulomb_up where x' > 0, coulomb_down where x' < 0
///
/// At rest it stays while F - k x is within [-coulomb_down, coulomb_up]. Places are relative to where the
/// spring rests. In metres and N, or in rad and N·m.
struct HeldMass {
  double mass_kg = 1.0;            ///< m, > 0
  double damping_n_s_per_m = 0.0;  ///< c, >= 0
  double stiffness_n_per_m = 0.0;  ///< k, >= 0
  double coulomb_up_n = 0.0;       ///< >= 0
  double coulomb_down_n = 0.0;     ///< >= 0

  [[nodiscard]] constexpr bool is_linear() const noexcept {
    return coulomb_up_n == 0.0 && coulomb_down_n == 0.0;
  }
  /// The friction that a motion of this sign meets.
  [[nodiscard]] constexpr double friction_n(double sign) const noexcept {
    return sign > 0.0 ? coulomb_up_n : coulomb_down_n;
  }
  /// Its direction of motion now; 0 if friction holds it.
  [[nodiscard]] double direction(AxisMotion motion, double force_n) const noexcept {
    if (motion.speed_m_s != 0.0) return std::copysign(1.0, motion.speed_m_s);
    const double drive = force_n - stiffness_n_per_m * motion.position_m;
    return std::abs(drive) > friction_n(drive) ? std::copysign(1.0, drive) : 0.0;
  }

  /// x and v after a time, from x, v and a constant F before, without friction: a matrix exponential.
  struct Transition {
    double xx = 1.0, xv = 0.0, xf = 0.0;
    double vx = 0.0, vv = 1.0, vf = 0.0;
    [[nodiscard]] AxisMotion step(AxisMotion at, double force_n) const noexcept {
      return {xx * at.position_m + xv * at.speed_m_s + xf * force_n,
              vx * at.position_m + vv * at.speed_m_s + vf * force_n};
    }
  };
  [[nodiscard]] Transition over(double time_s) const noexcept;

  /// Its motion after any time under a constant force, as HeldMassMotion has it of one time; the exponentials
  /// are made on the way. Allocates nothing.
  [[nodiscard]] AxisMotion after(AxisMotion motion, double force_n, double time_s) const noexcept;
};

/// Motion of a HeldMass over one time under a constant force, without error of integration.
///
/// Where nothing changes its sign the motion is one product with a matrix exponential. Where the speed would
/// pass through zero, that moment is found to 2^-16 of the time by steps of half, a quarter, ... of it; from
/// there the axis sticks, while force and spring together stay within f_c, or moves back under the friction
/// of the other sign.
class HeldMassMotion {
 public:
  using Transition = HeldMass::Transition;

  HeldMassMotion(const HeldMass& mass, double time_s);

  [[nodiscard]] AxisMotion after(AxisMotion motion, double force_n) const noexcept {
    if (is_linear_) return levels_[0].step(motion, force_n);
    const double sign = mass_.direction(motion, force_n);
    if (sign == 0.0) return {motion.position_m, 0.0};
    const AxisMotion end = levels_[0].step(motion, force_n - sign * mass_.friction_n(sign));
    return end.speed_m_s * sign >= 0.0 ? end : through_rest(motion, force_n, sign);
  }

  /// The exponential itself, for the eigenvalues.
  [[nodiscard]] const Transition& transition() const noexcept { return levels_[0]; }

  static constexpr std::size_t halvings = 16;

 private:
  [[nodiscard]] AxisMotion through_rest(AxisMotion motion, double force_n, double sign) const noexcept;

  HeldMass mass_;
  bool is_linear_;
  std::array<Transition, halvings + 1> levels_;  ///< over 2^-i of the time
};

}  // namespace kerf::mechanisms
