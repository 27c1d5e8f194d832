#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <kerf/identification/output_error.h>
#include <kerf/identification/shots.h>

namespace kerf::identification {

/// A first model from nothing but data, by modulating functions [Shinbrot1957]: with w = (1 - s^2)^4 over a
/// window, s from -1 to 1, which is zero with three derivatives at both ends,
///
///     <w, u(t - d)> = m <w'', x> - b <w', x> + k <w, x> + f <w, sign x'> - o <w, 1>
///
/// is linear in all but the delay and takes no derivative of a reading; the delay is that of a grid of a
/// quarter of a tick up to `longest_delay_ticks` that leaves least. Nothing if the axis did not move.
[[nodiscard]] std::optional<PlacedModel> first_model(const AxisData& data, std::span<const Stretch> stretches,
                                                     std::size_t places, double longest_delay_ticks = 8.0);

/// The ratio k_u of the force that acts to the force that is commanded, against a sensor between device and
/// hand that reads what the hand exerts on the device:
///
///     <w, F_s> = m <w'', x> - b <w', x> + f <w, sign x'> - o <w, 1> - k_u <w, u(t - d)>
///
/// with sign x' and its friction as the fit has them, also where the axis sticks.
/// Nothing if the sensor reads nothing that moves with the axis, as where nobody holds it.
struct MotorConstant {
  double value = 0.0;
  double half_width = 0.0;  ///< of 95 %
};
[[nodiscard]] std::optional<MotorConstant> motor_constant(const AxisData& data,
                                                          std::span<const double> sensor_n,
                                                          std::span<const Stretch> stretches,
                                                          const OutputErrorFit& fit);

}  // namespace kerf::identification
