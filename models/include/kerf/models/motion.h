#pragma once

#include <array>
#include <cstddef>

namespace kerf::models {

/// What a scalar law sees in one tick: how far the tool has engaged the tissue, and how fast it goes on.
///
/// For a probe or a blade the penetration is a depth [m]; for scissors it is the angle by which they have
/// closed since they met the tissue [rad]. Both grow into the tissue, so that a resisting force is positive
/// and force times velocity is the power into the tissue.
template <typename Signal>
struct MotionOf {
  Signal penetration = 0.0;  ///< x [m or rad]; negative before contact
  Signal velocity = 0.0;     ///< v = dx/dt [m/s or rad/s]
};
using Motion = MotionOf<double>;

inline constexpr std::size_t max_law_axes = 6;

/// One number per axis of a spatial law, in the order of its axes; unused ones are zero.
using AxisValues = std::array<double, max_law_axes>;

/// What a spatial law sees in one tick: the axes of the device themselves, in their own frame.
struct SpatialMotion {
  AxisValues position{};  ///< [m or rad]
  AxisValues velocity{};  ///< its derivative [m/s or rad/s]
};

/// Where along a device's axis the tissue begins, and which direction leads into it.
///
///     x = direction (position - contact)
///
/// Scissors whose angle is measured between the blades close with direction -1; an extension or an
/// indentation has direction +1.
struct Contact {
  double position = 0.0;   ///< position of first contact [m or rad]
  double direction = 1.0;  ///< +1 if the position grows into the tissue, -1 if it shrinks

  [[nodiscard]] Motion motion(double axis_position, double axis_velocity) const noexcept {
    return {.penetration = direction * (axis_position - position), .velocity = direction * axis_velocity};
  }
  /// In the sense of the axis, for a force that is positive where the tissue resists.
  [[nodiscard]] double force_on_axis(double resisting) const noexcept { return -direction * resisting; }
};

}  // namespace kerf::models
