#pragma once

#include <cstddef>

#include "stability/several/sampled_axes.h"

namespace kerf::bench {

/// A wall that turns with the tool, in the plane of two axes:
///
///     K_k = R(w k T) K R(w k T)^T,   B_k likewise
///
/// Where it `drags`, its damping acts on the speed against the turning tool, x' - w J x with J the quarter
/// turn from the first axis to the second, so that it has the stiffness K - w B J: its skew part pushes
/// sideways.
struct TurningWall {
  WallOfAxes wall;  ///< at the angle 0
  Eigen::Index first_axis = 0;
  Eigen::Index second_axis = 1;
  double rate_rad_s = 0.0;  ///< w; negative: the other way
  bool drags = false;

  [[nodiscard]] bool turns() const noexcept { return rate_rad_s != 0.0; }
};

/// R(angle), n by n.
[[nodiscard]] Eigen::MatrixXd rotation_in_plane(Eigen::Index axes, Eigen::Index first, Eigen::Index second,
                                                double angle_rad);
/// The wall turned by an angle, with the skew part of its drag.
[[nodiscard]] WallOfAxes wall_at(const TurningWall& wall, double angle_rad);

/// A turn takes whole ticks: so many, at least 4 and at most `most_ticks_of_a_turn`, and the rate is that at
/// which it does. @throws std::invalid_argument beyond.
inline constexpr std::size_t most_ticks_of_a_turn = 20'000;
[[nodiscard]] std::size_t ticks_of_a_turn(const TurningWall& wall, double period_s);

/// Logarithm of what a motion grows by in a tick: of the largest eigenvalue of the product of the ticks of a
/// turn (Floquet's multipliers), or of the one tick of a wall that does not turn.
[[nodiscard]] double growth(const SystemOfAxes& system, const TurningWall& wall, double period_s);
/// The same by simulated_growth(): the time domain over a turn, and the motions carried on.
[[nodiscard]] double simulated_growth(const SystemOfAxes& system, const TurningWall& wall, double period_s);

}  // namespace kerf::bench
