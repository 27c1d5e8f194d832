#pragma once

#include <kerf/mechanisms/woodenhaptics.h>

/// What all generations of WoodenHaptics tell of their axes alike.
namespace kerf::drivers::woodenhaptics {

inline constexpr double workspace_m = 0.1;      ///< to each side of its middle
inline constexpr double speed_limit_m_s = 5.0;  ///< assumed, as the next two
inline constexpr double slew_limit_n_s = 2000.0;
inline constexpr double acceleration_limit_m_s2 = 200.0;

/// How far the tip moves along each axis for one count of each encoder, in the middle [m].
inline mechanisms::WoodenHaptics::Matrix steps_in_the_middle(const mechanisms::WoodenHaptics& mechanism) {
  using Vector = mechanisms::WoodenHaptics::Vector;
  const Vector middle = *mechanism.angles_of(mechanism.configuration().centre_m);
  const Vector count = (mechanism.angles({1, 1, 1}) - mechanism.angles({0, 0, 0})).cwiseAbs();
  return mechanism.jacobian(middle).cwiseAbs() * count.asDiagonal();
}

}  // namespace kerf::drivers::woodenhaptics
