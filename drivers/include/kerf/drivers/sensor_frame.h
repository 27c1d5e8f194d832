#pragma once

#include <array>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

namespace kerf::drivers {

/// How a force sensor stands in the device beside it. It tells f [N] and t [N·m] in axes of its own, about an
/// origin of its own; what the device's axes want is
///
///     f' = R f,   t' = R (t - r x f)
///
/// R turns a vector of the sensor's axes into the device's: its rows are the device's x, y and z in the
/// sensor's axes. r [m] leads from the sensor's origin to the tip, the point that x, y and z of the device
/// move, in the sensor's axes. A component that is not known (NaN) leaves those unknown that depend on it,
/// and no others.
struct SensorFrame {
  using Vector = std::array<double, 3>;
  std::array<Vector, 3> rotation{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};  ///< R, by rows
  Vector tool_m{};                                                                      ///< r

  /// The wrench fx, fy, fz, tx, ty, tz as the device's axes want it.
  [[nodiscard]] Axes apply(const Axes& wrench) const noexcept;
};

/// What keeps three rows from being a rotation, in words: "row 2 has the length 1.2"; empty: they are one, to
/// a thousandth.
[[nodiscard]] std::string no_rotation(const std::array<SensorFrame::Vector, 3>& rows);

/// What keeps a sensor of these axes from having a frame; empty: it may. It has to tell x, y and z in N and,
/// behind them, either nothing or rx, ry and rz in N·m.
[[nodiscard]] std::string no_frame_for(const std::vector<AxisInfo>& axes);

/// As a recording keeps it: `rotation = [[...], ...]`, `tool = [...] # m`.
[[nodiscard]] std::string to_toml(const SensorFrame& frame);

}  // namespace kerf::drivers
