#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "stability/device/sampled_device.h"

namespace kerf::bench {

/// Where an axis is and how fast it moves.
struct AxisMotion {
  double position_m = 0.0;
  double speed_m_s = 0.0;
};

/// Motion of a device and hand over a fixed time under a constant force, without error of integration:
///
///     M x'' = F - c x' - k x - f_c sign(x')
///
/// Where nothing changes its sign the motion is one product with a matrix exponential. Where the speed would
/// pass through zero, that moment is found to 2^-16 of the time by steps of half, a quarter, ... of it; from
/// there the axis sticks, while force and spring together stay within f_c, or moves back under the friction
/// of the other sign. Places are relative to where the hand's spring rests.
class FreeMotion {
 public:
  FreeMotion(const SampledDevice& device, double time_s);

  [[nodiscard]] AxisMotion after(AxisMotion motion, double force_n) const noexcept {
    if (coulomb_n_ == 0.0) return levels_[0].step(motion, force_n);
    const double sign = direction(motion, force_n);
    if (sign == 0.0) return {motion.position_m, 0.0};
    const AxisMotion end = levels_[0].step(motion, force_n - sign * coulomb_n_);
    return end.speed_m_s * sign >= 0.0 ? end : through_rest(motion, force_n, sign);
  }

  /// The exponential itself, for the eigenvalues: x and v after, from x, v and F before, without friction.
  struct Transition {
    double xx = 1.0, xv = 0.0, xf = 0.0;
    double vx = 0.0, vv = 1.0, vf = 0.0;
    [[nodiscard]] AxisMotion step(AxisMotion at, double force_n) const noexcept {
      return {xx * at.position_m + xv * at.speed_m_s + xf * force_n,
              vx * at.position_m + vv * at.speed_m_s + vf * force_n};
    }
  };
  [[nodiscard]] const Transition& transition() const noexcept { return levels_[0]; }

 private:
  static constexpr std::size_t halvings = 16;

  /// Its direction of motion now; 0 if friction holds it.
  [[nodiscard]] double direction(AxisMotion motion, double force_n) const noexcept {
    if (motion.speed_m_s != 0.0) return std::copysign(1.0, motion.speed_m_s);
    const double drive = force_n - stiffness_n_per_m_ * motion.position_m;
    return std::abs(drive) > coulomb_n_ ? std::copysign(1.0, drive) : 0.0;
  }
  [[nodiscard]] AxisMotion through_rest(AxisMotion motion, double force_n, double sign) const noexcept;

  double coulomb_n_;
  double stiffness_n_per_m_;
  std::array<Transition, halvings + 1> levels_;  ///< over 2^-i of the time
};

}  // namespace kerf::bench
