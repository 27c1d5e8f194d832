#pragma once

#include <limits>
#include <optional>
#include <string>

#include <kerf/fitting/jnd.h>

#include "stability/device/sampled_device.h"
#include "stability/law_force.h"
#include "stability/strokes.h"

namespace kerf::bench {

/// How deep and how fast a tool goes into a law.
struct ToolRange {
  double depth_m = 0.01;
  double speed_m_s = 0.2;
};

/// Whether a law pushes or pulls anywhere where a tool goes to a depth and back at a speed. Of one that is
/// never met no stroke says anything.
[[nodiscard]] bool is_met(const AxisLaw& law, const ToolRange& range, double period_s);

/// Whether no stroke that ends at a depth, at up to a speed, is given energy (strokes.h).
[[nodiscard]] bool is_passive_at(const SampledDevice& device, const AxisLaw& law, const ToolRange& range);

/// The same at that depth and at parts of it, down to a hundredth.
[[nodiscard]] bool is_passive(const SampledDevice& device, const AxisLaw& law, const ToolRange& range);

/// A stroke and the energy that it is given [J].
struct Gain {
  Stroke stroke;
  double energy_j = 0.0;
};
/// The stroke that is given most, of those of is_passive(); nothing if it is.
[[nodiscard]] std::optional<Gain> worst_stroke(const SampledDevice& device, const AxisLaw& law,
                                               const ToolRange& range);

/// Stiffness that a device renders passively beside a damping B to motions up to a speed v [N/m]:
///
///     K = min over speeds of 2 ((b - q |B|) v + f_c) / (delta + v T + 2 v t_d)
///
/// at v and, with an encoder, at rest: the balance of one tick at a constant speed. What the held force lags
/// behind by the encoder, the hold and the delay t_d stands against what friction takes; q is
/// worst_of_damping(). For any speed, B and t_d zero, it is min(2 b / T, 2 f_c / delta), that of Abbott and
/// Okamura; without encoder and Coulomb friction that of Colgate and Schenkel. 0 where there is none.
[[nodiscard]] double passive_stiffness_up_to(const SampledDevice& device, double speed_m_s,
                                             double damping_n_s_per_m = 0.0);

/// What a law is like for small motions about a depth that it has come to slowly.
struct Local {
  double stiffness_n_per_m = 0.0;  ///< dF/dx within one period
  double damping_n_s_per_m = 0.0;  ///< dF/dv
};
[[nodiscard]] Local local_impedance(const AxisLaw& law, double depth_m, double period_s);

/// Whether the local stiffness at a depth is within passive_stiffness_up_to() the speed.
[[nodiscard]] bool is_locally_passive(const SampledDevice& device, const AxisLaw& law,
                                      const ToolRange& range);

/// Up to where something holds, of what was tried one after the other.
struct Limit {
  double first = 0.0;          ///< that was tried
  double last = 0.0;           ///< likewise
  std::optional<double> at;    ///< where it ends, between the two
  bool holds_nowhere = false;  ///< it fails at the first; without that and `at` it holds to the last
};

/// Where a law stops being passive on a device.
struct LawLimits {
  Limit depth_m;               ///< deepest, at the range's speed
  Limit speed_m_s;             ///< steepest approach, to the range's depth
  Limit rate_hz;               ///< lowest, for the range's depth and speed; tried from the highest
  bool passive_at_all = true;  ///< false: it gains energy however shallow, slow and fast sampled
  Local local;                 ///< at depth_m, or at the range's depth
  double passive_stiffness_n_per_m =
      0.0;              ///< passive_stiffness_up_to() the range's speed beside that damping
  Limit local_depth_m;  ///< where is_locally_passive() ends
};

/// Finds them by bisection to 0.5 %: depth up to `deepest_m`, speed up to 10 m/s, rate from 20 Hz to 100 kHz.
[[nodiscard]] LawLimits limits_of(const SampledDevice& device, const AxisLaw& law, const ToolRange& range,
                                  double deepest_m);

/// How a hand presses a law: to a depth along a stroke of minimum jerk, and holds it there.
struct Press {
  double depth_m = 0.01;
  double approach_s = 0.3;
  double hold_s = 1.0;
  bool passivity_control = false;  ///< under the loop's passivity controller
};

/// Whether a hand that presses and holds feels a limit cycle.
struct PressVerdict {
  bool stable = true;
  double ripple_n = 0.0;  ///< rms of the force about its mean over the last quarter of the hold
  double peak_n = 0.0;    ///< largest force of the whole press
  double added_n = 0.0;   ///< rms of what a controller adds to the law's force, over the whole press
};

/// The hand's spring rests where the law at `depth_m` would hold it. Unstable: the force is not finite or
/// beyond 1 kN, or its ripple is over `felt_n` at the end and has not fallen by 10 % since the second
/// quarter. The device must be in a hand with a stiffness.
[[nodiscard]] PressVerdict press(const SampledDevice& device, const AxisLaw& law, const Press& how,
                                 double felt_n = fitting::force_jnd.threshold);

}  // namespace kerf::bench
