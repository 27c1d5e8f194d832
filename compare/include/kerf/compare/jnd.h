#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

namespace kerf::compare {

/// What of a force or a torque a person can feel: the larger of a Weber fraction of it and an absolute
/// threshold.
struct Jnd {
  double weber_fraction = 0.07;
  double threshold = 0.05;  ///< in the unit of what is felt
  [[nodiscard]] double at(double felt) const noexcept {
    return std::max(weber_fraction * std::abs(felt), threshold);
  }
};

/// Of a force [N]: [Pang1991] (7 %); order of magnitude at the fingertips (0.05 N).
inline constexpr Jnd force_jnd{};

/// From the fingers to an axis that they turn, where nothing else is said of it.
inline constexpr double fingers_m = 0.01;

/// Of a torque about an axis between two fingers [N·m]: [JanduraSrinivasan1994] (12.7 % at 60 mN·m); the
/// threshold is assumed, that of a force at the fingers.
inline constexpr Jnd torque_jnd{.weber_fraction = 0.127, .threshold = 5e-4};

/// Of what an axis exerts: a force in N; a torque in N·m as the force at the hand, where the axis names the
/// lever to it, else between fingers.
[[nodiscard]] Jnd jnd_of(std::string_view force_unit, double axis_lever = 1.0) noexcept;

/// Who measured that, in words.
[[nodiscard]] std::string_view jnd_source_of(std::string_view force_unit, double axis_lever = 1.0) noexcept;

/// The lever by which a force at the hand gives what an axis has [m]: 1 for a force in N; for a torque in N·m
/// that of the axis, and `fingers_m` where it names none (1).
[[nodiscard]] double felt_lever(std::string_view force_unit, double axis_lever = 1.0) noexcept;

/// Root mean square, at which the JND of a whole recording is taken.
[[nodiscard]] double rms_of(std::span<const double> force);

}  // namespace kerf::compare
