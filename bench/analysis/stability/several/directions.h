#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plot/plot.h"
#include "stability/maps.h"
#include "stability/several/sufficient.h"

namespace kerf::bench {

/// Several axes of a device with the hand on them, by name.
struct NamedAxes {
  std::vector<std::string> names;
  SampledAxes device;         ///< without a hand
  Eigen::MatrixXd hand_mass;  ///< n by n; added to the device's
  Eigen::MatrixXd hand_damping;
  Eigen::MatrixXd hand_stiffness;

  /// Device and hand as one.
  [[nodiscard]] SampledAxes in_hand() const;
};

/// Largest stiffness k [N/m] in one direction of the plane.
struct DirectionBoundary {
  double angle_rad = 0.0;
  double eigenvalues = 0.0;  ///< growth() is 0
  double simulated = 0.0;    ///< simulated_growth() is 0
  double sufficient = 0.0;   ///< sufficient_condition() holds up to there, in the hand
  double passive = 0.0;      ///< and with the device's own friction alone, in any hand; 0 where it turns
  double one_axis = 0.0;     ///< of eigenvalues along the direction alone, the others left free
};

struct DirectionMap {
  NamedAxes axes;
  TurningWall shape;
  Range searched;  ///< [N/m]
  std::vector<DirectionBoundary> boundaries;

  /// Largest difference of the simulated boundary to that of the eigenvalues, as a share of it, over those
  /// that lie within the search.
  [[nodiscard]] double boundary_error() const;
};

/// Boundaries of a wall of one shape whose stiffness and direction are varied: K = k R(angle) shape
/// R(angle)^T, the angle in the plane of the wall's two axes; its damping turns likewise and is not varied.
/// At `directions` angles of half a turn (a wall is the same from behind). A tool that turns passes all of
/// them: it has one boundary, which stands at each angle.
/// @throws std::invalid_argument as check() and ticks_of_a_turn(); std::system_error if it was stopped.
[[nodiscard]] DirectionMap direction_map(const NamedAxes& axes, const TurningWall& shape,
                                         std::size_t directions, Range searched, const MapOptions& options);

}  // namespace kerf::bench
