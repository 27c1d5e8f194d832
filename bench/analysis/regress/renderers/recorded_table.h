#pragma once

#include <filesystem>
#include <vector>

#include <kerf/schema/recording.h>

#include "regress/renderers/number_table.h"
#include "regress/renderers/trajectory_table.h"

namespace kerf::bench {

/// Whether a file is named as a recording, NAME.h5, and not as a table of text.
[[nodiscard]] bool is_recording(const std::filesystem::path& file);

/// A motion as a recording without forces: periods and quaternions are channels of it.
[[nodiscard]] schema::Recording trajectory_recording(const SampledMotion& motion,
                                                     const TrajectoryColumns& columns);

/// A motion, of a recording or of a table, on axes by their names.
/// @throws std::invalid_argument and schema::FormatError with the file: as read_trajectory_csv().
[[nodiscard]] SampledMotion read_trajectory(const std::filesystem::path& file,
                                            const std::vector<models::LawAxis>& axes);

/// The forces of a recording on those axes, as a renderer's table has them: those commanded, else those
/// measured; with compute times and faults where it has them, and what its scene says of sign, frame and
/// quaternion.
/// @throws std::invalid_argument and schema::FormatError with the file: no forces, an axis that is missing or
/// in another unit.
[[nodiscard]] NumberTable read_force_recording(const std::filesystem::path& file,
                                               const std::vector<models::LawAxis>& axes);

}  // namespace kerf::bench
