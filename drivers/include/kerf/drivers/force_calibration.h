#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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
  /// Which components it tells; the wrench of the others is NaN.
  std::array<bool, max_axes> tells{true, true, true, true, true, true};
  std::optional<std::chrono::year_month_day> date{};  ///< when it was calibrated
  std::optional<std::string> serial_number{};         ///< of the transducer
  std::optional<double> temperature{};                ///< at which it was calibrated [degC]
  double stale_after_days = 365.0;                    ///< after `date`
  std::optional<Axes> noise_v{};                      ///< of one reading, standard deviation
  std::optional<Axes> bias_half_width_v{};            ///< of the 95 % interval of the bias

  /// The wrench of voltages; no allocation.
  [[nodiscard]] Axes wrench(const Axes& volts) const noexcept;
};

/// The components, in their order.
inline constexpr std::array<const char*, max_axes> wrench_names{"fx", "fy", "fz", "tx", "ty", "tz"};

/// "-tz": the index of a component and its sign; nothing of what is none.
struct SignedComponent {
  std::size_t component = 0;
  double sign = 1.0;
};
[[nodiscard]] std::optional<SignedComponent> signed_component(std::string_view text) noexcept;

/// Reads a calibration from TOML:
///
///     provenance = "transducer S/N 1234, certificate of 2026-01-31"   # required
///     serial = 360012345                                              # optional
///     units = { force = "N", torque = "N·m", signal = "V" }           # required
///     matrix = [ [six numbers], ... ]    # rows fx fy fz [force per signal], tx ty tz [torque per signal]
///     bias = [six numbers]               # signal without load
///     components = ["fz"]                # optional: of a sensor with fewer; then `matrix` has as many rows,
///                                        # and rows and bias one to six numbers, of AIN0/1, 2/3, ...
///     date = 2026-11-28                  # optional, as all below: when it was calibrated
///     serial_number = "FT1234"           # of the transducer
///     temperature = 22.5                 # at which it was calibrated [degC]
///     stale_after = 365                  # days
///     [quality]                          # what `kerf calibrate` found; noise and bias_half_width are used
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

/// What ought to be known before the calibration is used on a day, a line each: it is older than it should
/// be, or for the transducer of another serial number than `transducer` (empty: not known).
[[nodiscard]] std::vector<std::string> doubts_of(const ForceCalibration& calibration, const std::string& file,
                                                 std::chrono::sys_days today,
                                                 const std::string& transducer = {});

/// A line if the mean of `readings` readings of each signal is farther from the bias than five standard
/// deviations of noise and bias explain, else nothing; nothing, too, of a file that does not say its noise.
[[nodiscard]] std::optional<std::string> moved_bias(const ForceCalibration& calibration,
                                                    const std::string& file, const Axes& mean_v,
                                                    double readings);

/// The calibration as TOML in one table without sub-tables, in SI, each number as it is to the last bit.
[[nodiscard]] std::string to_toml(const ForceCalibration& calibration);

}  // namespace kerf::drivers
