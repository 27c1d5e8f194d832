#pragma once

#include <limits>
#include <optional>
#include <string>

#include "stability/law_force.h"
#include "stability/sampled_device.h"

namespace kerf::bench {

/// How deep and how fast a tool goes into a law.
struct ToolRange {
  double depth_m = 0.01;
  double speed_m_s = 0.2;
};

/// Whether any stroke to a depth, up to a speed, is given energy (strokes.h).
[[nodiscard]] bool is_passive(const SampledDevice& device, const AxisLaw& law, const ToolRange& range);

/// Stiffness that a device renders passively to motions up to a speed v [N/m]:
///
///     K = min over speeds of 2 (b v + f_c) / (delta + v T + 2 v t_d),   at v and, with an encoder, at rest
///
/// the balance of one tick at a constant speed: what the held force lags behind by the encoder, the hold and
/// the delay t_d, against what friction takes. For any speed it is min(2 b / (T + 2 t_d), 2 f_c / delta),
/// that of Abbott and Okamura with a delay.
[[nodiscard]] double passive_stiffness_up_to(const SampledDevice& device, double speed_m_s);

/// Where a law stops being passive on a device. A limit that was not found within the search is empty.
struct LawLimits {
  std::optional<double> depth_m;         ///< deepest, at the range's speed
  std::optional<double> speed_m_s;       ///< steepest approach, to the range's depth
  std::optional<double> rate_hz;         ///< lowest, for the range's depth and speed
  bool passive_at_all = true;            ///< false: it gains energy however shallow, slow and fast sampled
  double local_stiffness_n_per_m = 0;    ///< of the law at depth_m, or at the range's depth
  double passive_stiffness_n_per_m = 0;  ///< passive_stiffness_up_to() the range's speed
  std::optional<double> depth_by_stiffness_m;  ///< where the local stiffness reaches that
};

/// Finds them by bisection to 0.5 %: depth up to `deepest_m`, speed up to 10 m/s, rate from 20 Hz to 100 kHz.
[[nodiscard]] LawLimits limits_of(const SampledDevice& device, const AxisLaw& law, const ToolRange& range,
                                  double deepest_m);

/// dF/dx of a law that has come to a depth slowly and is moved on by a little within one period [N/m].
[[nodiscard]] double local_stiffness(const AxisLaw& law, double depth_m, double period_s);

/// How a hand presses a law: to a depth along a stroke of minimum jerk, and holds it there.
struct Press {
  double depth_m = 0.01;
  double approach_s = 0.3;
  double hold_s = 1.0;
};

/// Whether a hand that presses and holds feels a hum.
struct PressVerdict {
  bool stable = true;
  double ripple_n = 0.0;  ///< rms of the force about its mean over the last quarter of the hold
  double peak_n = 0.0;    ///< largest force of the whole press
};

/// The hand's spring rests where the law at `depth_m` would hold it. Unstable: the force is not finite or
/// beyond 1 kN, or its ripple is over `felt_n` at the end and has not fallen by 10 % since the second
/// quarter. The device must be in a hand with a stiffness.
[[nodiscard]] PressVerdict press(const SampledDevice& device, const AxisLaw& law, const Press& how,
                                 double felt_n = 0.05);

}  // namespace kerf::bench
