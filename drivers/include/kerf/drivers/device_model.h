#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>

namespace kerf::drivers {

/// A number that was estimated, and its interval of 95 %. A bound may be infinite where the data have none.
struct Estimate {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;

  /// A number that is known, as of a simulated device.
  [[nodiscard]] static constexpr Estimate exactly(double value) noexcept { return {value, value, value}; }
  bool operator==(const Estimate&) const = default;
};
/// Nothing: unknown, which is no zero.
using Known = std::optional<Estimate>;

/// The force of gravity (and of whatever else does not change with time) along an axis: at so many places.
struct GravityTable {
  std::vector<double> position;  ///< in the unit of position, growing
  std::vector<double> force;     ///< in the unit of force, positive where it pushes the position up

  /// Between two places along the straight line; beyond the ends as at the ends. At least one place.
  [[nodiscard]] double at(double place) const noexcept;
  bool operator==(const GravityTable&) const = default;
};

/// How well an axis' model foretold data that it was not made of.
struct ModelValidation {
  std::optional<bool> fits;            ///< nothing: nobody has looked
  std::optional<double> error;         ///< rms of what it missed, as a share of the rms of what moved
  std::string verdict;                 ///< "this model predicts the device to 2.1 %"
  std::vector<std::string> why_not{};  ///< reasons where it does not fit, a line each
  bool operator==(const ModelValidation&) const = default;
};

/// The limits that the driver told when the axis was measured, in the units of its position and force.
struct ModelLimits {
  double lower = 0.0;
  double upper = 0.0;
  double force = 0.0;
  double slew = 0.0;
  double speed = 0.0;
  double acceleration = 0.0;
  bool operator==(const ModelLimits&) const = default;
};

/// One axis as it was identified:
///
///     m x'' + b x' + f_c sign(x') = k_u sat(u(t - delay)) + g(x)
///
/// of the travel x of its lever (of the joint where the lever is 1), with f_c one number for each direction.
struct AxisModel {
  std::string name;
  std::string position_unit = "m";  ///< "m" or "rad"
  std::string force_unit = "N";     ///< "N" or "N·m"
  double lever = 1.0;               ///< as AxisInfo::lever
  ModelLimits limits;

  Known mass;             ///< m [kg, or kg·m² where the force is in N·m]
  Known viscous;          ///< b [N·s/m, N·m·s/rad]
  Known coulomb_up;       ///< f_c while the position grows [N, N·m], >= 0
  Known coulomb_down;     ///< f_c while it shrinks
  Known gravity;          ///< g where it was measured, positive where it pushes the position up
  Known stiffness;        ///< of the structure between motor and handle, where it shows [N/m, N·m/rad]
  Known delay;            ///< from a reading to the force that it led to [s]; fractions of a tick count
  Known delay_jitter;     ///< its standard deviation [s]
  Known encoder_step;     ///< in the unit of position
  Known velocity_noise;   ///< rms of the velocity at rest, in the unit of position a second
  Known velocity_corner;  ///< of the velocity's filter of first order [rad/s]
  Known motor_constant;   ///< k_u: force acting over force commanded, against a sensor [1]
  Known saturation;       ///< largest force that acts, whatever is commanded, in the unit of force

  /// The hand that held it meanwhile, at the travel of the lever, if any did.
  Known hand_mass, hand_damping, hand_stiffness;

  std::optional<GravityTable> gravity_table;
  ModelValidation validation;

  /// f_c of both directions; nothing unless both are known.
  [[nodiscard]] std::optional<double> coulomb() const noexcept;
  /// Mass and friction; nothing unless all of them are known.
  [[nodiscard]] std::optional<Mechanics> mechanics() const noexcept;
  bool operator==(const AxisModel&) const = default;
};

/// A device as it was identified, and under which conditions. docs/device-models.md has the file.
struct DeviceModel {
  static constexpr int format = 1;

  std::string kerf;  ///< version and commit of the program that made it
  std::string date;  ///< UTC, "2026-01-31T12:00:00Z"
  double rate_hz = 0.0;
  bool held = false;       ///< in a hand; else nobody touched it
  std::string conditions;  ///< in words, as whoever measured it wrote them
  std::optional<double> temperature_degc;

  std::string uri;                    ///< what was opened
  std::string model;                  ///< as DeviceInfo::model, which names the generation too
  std::optional<std::string> serial;  ///< as DeviceInfo::serial
  std::string port;                   ///< as DeviceInfo::port

  std::vector<AxisModel> axes;

  [[nodiscard]] const AxisModel* axis(std::string_view name) const noexcept;
  /// false if any axis is said not to fit, true if all are said to; else nothing.
  [[nodiscard]] std::optional<bool> fits() const noexcept;
  /// Of all axes, each with its axis' name before it.
  [[nodiscard]] std::vector<std::string> why_not() const;
  bool operator==(const DeviceModel&) const = default;
};

/// A number of an axis' model, by the key that it has in files.
struct AxisNumber {
  enum class Unit : unsigned char { mass, damping, force, stiffness, time, position, speed, corner, ratio };
  std::string_view key;
  Unit unit;
  bool may_be_negative;
  Known AxisModel::*member;
};
/// All of them but the hand's, in the order of a file.
[[nodiscard]] const std::array<AxisNumber, 13>& axis_numbers() noexcept;
/// The hand's: mass, damping, stiffness.
[[nodiscard]] const std::array<AxisNumber, 3>& hand_numbers() noexcept;
/// "kg" or "kg·m²", ...: the unit that a number has on an axis.
[[nodiscard]] std::string unit_of(const AxisNumber& number, const AxisModel& axis);

/// An axis of a device with what its driver says of it and nothing that would have to be measured.
[[nodiscard]] AxisModel axis_model_of(const AxisInfo& axis);

/// Reads NAME.device.toml. @throws DeviceError in one line with file, line and key: no TOML, a key that there
/// is not, a number without its unit or with another one, an interval that does not hold its value, a value
/// that cannot be (a mass of 0), a later format; std::invalid_argument if the file cannot be read.
[[nodiscard]] DeviceModel read_device_model(const std::string& file);
/// The same from a text; `name` for the messages.
[[nodiscard]] DeviceModel parse_device_model(const std::string& text, const std::string& name);

/// The file: each number as it is to the last bit.
[[nodiscard]] std::string to_toml(const DeviceModel& model);

}  // namespace kerf::drivers
