#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "stability/device/sampled_loop.h"

namespace kerf::bench {

/// A motion that a hand forces on a device, to and fro at one speed; it turns at a tick.
struct Stroke {
  double from_m = 0.0;
  double to_m = 0.0;      ///< deeper than from_m
  std::size_t ticks = 1;  ///< in one direction

  [[nodiscard]] double speed_m_s(double period_s) const noexcept {
    return (to_m - from_m) / (static_cast<double>(ticks) * period_s);
  }
};

/// Energy that a rendering and the device's friction give to the hand in the last of some strokes to and fro
/// [J]:
///
///     E = sum of F_held dx - b dx^2 / T - f_c |dx|
///
/// Between two ticks a straight line costs the least friction, so strokes of this form are the worst a hand
/// can do to a wall: of constant speed for a spring (K T / 2 > b), of one tick for a damper (B > b). The
/// encoder is taken at its worst, half a step behind the motion, where a hand may always bring it. More than
/// nothing proves that the rendering is not passive; that no stroke gains is no proof that it is.
template <typename Force>
[[nodiscard]] double energy_gained(const SampledDevice& device, Force force, const Stroke& stroke,
                                   int times = 4) {
  const SplitDelay delay(device);
  SampledDevice smooth = device;
  smooth.encoder_step_m = 0.0;  // half a step behind instead
  AxisSensor sensor(smooth);
  CommandDelay line(delay.ticks);
  const double step_m = (stroke.to_m - stroke.from_m) / static_cast<double>(stroke.ticks);
  const double friction_j =
      device.viscous_n_s_per_m * step_m * step_m / device.period_s + device.coulomb_n * step_m;
  double position_m = stroke.from_m;
  double held_n = 0.0;
  double gained_j = 0.0;
  // The last pass counts, and what arrives in it is of a pass, and not of the rest before.
  const std::size_t passes = std::max(static_cast<std::size_t>(times), delay.ticks / (2 * stroke.ticks) + 3);
  for (std::size_t leg = 0; leg < 2 * passes; ++leg) {
    const double direction = leg % 2 == 0 ? 1.0 : -1.0;
    if (leg == 2 * passes - 2) gained_j = 0.0;
    for (std::size_t tick = 0; tick < stroke.ticks; ++tick) {
      const double arrived =
          line.pass(force(sensor.read(position_m - 0.5 * direction * device.encoder_step_m)));
      gained_j += direction * step_m * (delay.share * held_n + (1.0 - delay.share) * arrived) - friction_j;
      held_n = arrived;
      position_m += direction * step_m;
    }
  }
  return gained_j;
}

/// Strokes that end at a depth, of a hundredth of it to all of it, in one tick to hundreds, none faster than
/// `fastest_m_s`.
[[nodiscard]] std::vector<Stroke> strokes_at(double depth_m, double fastest_m_s, double period_s);

}  // namespace kerf::bench
