#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <kerf/drivers/device.h>

namespace kerf::drivers {

/// Makes the wrench of a six-axis force/torque transducer out of its six voltages:
///
///     w = M (u - u_0),   w = (fx, fy, fz [N], tx, ty, tz [N·m]),   u [V]
///
/// in the transducer's own frame, of the force that acts on it. M and the bias u_0 are the maker's and the
/// lab's: no program can know them, so they stand in a file that goes into every recording.
struct ForceCalibration {
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();  ///< M, rows N/V and N·m/V
  Eigen::Matrix<double, 6, 1> bias_v = Eigen::Matrix<double, 6, 1>::Zero();  ///< u_0
  std::optional<std::uint32_t> serial;  ///< of the LabJack whose inputs the transducer is wired to
  std::string provenance;               ///< where the numbers come from
  std::vector<ForceMount> mounts;       ///< which component acts on which axis of the device beside it

  /// The wrench of voltages; no allocation.
  [[nodiscard]] Axes wrench(const Axes& volts) const noexcept;
};

/// The components, in their order.
inline constexpr std::array<const char*, max_axes> wrench_names{"fx", "fy", "fz", "tx", "ty", "tz"};

/// Reads a calibration from TOML:
///
///     provenance = "transducer S/N 1234, certificate of 2026-01-31"   # required
///     serial = 360012345                                              # optional
///     units = { force = "N", torque = "N·m", signal = "V" }           # required
///     matrix = [ [six numbers], ... ]    # rows fx fy fz [force per signal], tx ty tz [torque per signal]
///     bias = [six numbers]               # signal without load
///     [axes]                             # optional: component of an axis that is not called x ... rz
///     theta = { component = "-tz", lever_m = 0.0369 }
///     x_s = "fx"
///
/// Forces in N, mN or lbf, torques in N·m, N·mm or lbf·in, signals in V or mV. A lever [m] stands between a
/// torque and an axis whose force is in N (F = t / lever) or a force and an axis in N·m (t = F lever).
/// @throws DeviceError in one line with file, line and key; std::invalid_argument if the file cannot be read.
[[nodiscard]] ForceCalibration read_force_calibration(const std::string& file);
/// The same from a text; `name` for the messages.
[[nodiscard]] ForceCalibration parse_force_calibration(const std::string& text, const std::string& name);

/// The calibration as TOML in one table without sub-tables, in SI, each number as it is to the last bit.
[[nodiscard]] std::string to_toml(const ForceCalibration& calibration);

}  // namespace kerf::drivers
