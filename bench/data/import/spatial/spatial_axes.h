#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "import/column_map.h"
#include "import/spatial/spatial_columns.h"

namespace kerf::bench {

/// The numbers of the mapped columns, in their order and in SI.
using MappedValues = std::vector<std::vector<double>>;

/// @throws std::invalid_argument that names the first row whose orientation is none.
void require_rotations(const SpatialMap& map, const std::vector<MappedColumn>& columns,
                       const MappedValues& values, const std::string& name,
                       const std::function<std::size_t(std::size_t)>& line_of_row);

/// Where a file's positions and wrenches are counted from.
struct SpatialPlaces {
  std::array<double, 3> origin_m{};              ///< subtracted from the positions
  std::optional<std::array<double, 3>> point_m;  ///< P, about which the file's torques are, in its wrench's
                                                 ///< frame; none: the position
  /// Rotation vector of S, from the axes of the sensor, in which the wrench was measured, to those of the
  /// tool, of which the orientation is: f and m below are S times what the file says [rad].
  std::optional<std::array<double, 3>> sensor_rotation_rad;
};

/// Makes the axes x, y, z of a recording, and rx, ry, rz if there is an orientation, with the force measured.
///
/// x, y, z is the position p less the origin; rx, ry, rz the rotation vector r of R, from the sensor's frame
/// to the world's, without jumps (RotationPath). Forces stand in the world's axes; torques are those that go
/// with r, so that force times velocity is power: with f, m of the file and P where they act,
///
///     sensor:  F = R f,  M = R (m + P x f)
///     world:   F = f,    M = m + (P - p) x f
///     torque of rx, ry, rz = J(r)^T M,   J the left Jacobian
///
/// Where no torque is mapped it is NaN. `device_properties` of the header say the file's frame and that
/// torques are generalised ones. Returns what there is to warn of.
std::vector<std::string> take_spatial_axes(schema::Recording& recording, const SpatialMap& map,
                                           const std::vector<MappedColumn>& columns,
                                           const MappedValues& values, const SpatialPlaces& places);

/// Axes, form, frame and places in a sentence, for history and terminal.
[[nodiscard]] std::string spatial_text(const SpatialMap& map, const SpatialPlaces& places);

/// Derives the velocity of every axis from its positions.
void derive_velocities(schema::Recording& recording, double window_s);

}  // namespace kerf::bench
