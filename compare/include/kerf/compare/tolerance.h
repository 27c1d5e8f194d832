#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::compare {

/// A limit of forces and one of torques, in SI.
struct Limit {
  std::optional<double> force;   ///< of channels in N
  std::optional<double> torque;  ///< of channels in N·m
  [[nodiscard]] std::optional<double> of(std::string_view unit) const noexcept {
    return unit == "N·m" ? torque : force;
  }
  [[nodiscard]] bool given() const noexcept { return force || torque; }
};

struct ChannelTolerance;

/// How far a force may be from the expected one. Tick by tick as far as the largest of what is given,
///
///     |got - expected| <= max(absolute, relative |expected|, jnd JND(expected)),
///
/// or not at all, bit for bit. What a limit of each tick does not see, limits of the whole run do: they hold
/// besides. No number that is not finite is within any.
struct Tolerance {
  std::optional<double> force_n;     ///< absolute, of channels in N
  std::optional<double> torque_n_m;  ///< absolute, of channels in N·m
  std::optional<double> relative;
  std::optional<double> jnd;  ///< in JNDs of the expected force or torque
  bool exact = false;

  /// Largest RMS of the difference in any band of frequency, within any quarter of a second, in thresholds of
  /// vibration (vibration_threshold()). None: 2 where `jnd` is given, since persons differ
  /// by as much, else not looked at.
  std::optional<double> vibration;
  Limit slew;   ///< of the difference from tick to tick [N/s, N·m/s]
  Limit drift;  ///< of a straight line through the difference, from begin to end [N, N·m]
  Limit peak;   ///< between the largest |got| and the largest |expected| [N, N·m]

  std::vector<ChannelTolerance> channels;  ///< in place of all this, of one channel

  /// What holds for a channel.
  [[nodiscard]] const Tolerance& of(std::string_view channel) const noexcept;
  /// Whether anything is allowed tick by tick in channels of a unit.
  [[nodiscard]] bool has_limit_for(std::string_view unit) const noexcept;
  [[nodiscard]] std::optional<double> vibration_limit() const noexcept;
  /// How far a tick may be off.
  [[nodiscard]] double allowed(std::string_view unit, double expected) const noexcept;
};

struct ChannelTolerance {
  std::string channel;
  Tolerance tolerance;
};

}  // namespace kerf::compare
