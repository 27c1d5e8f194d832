#pragma once

#include <filesystem>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Reads a recording for work that has to see all its rows at once, several times over.
/// @throws as schema::read_recording(); std::system_error (ENOMEM) before it begins where there is no memory
/// for so many rows.
[[nodiscard]] schema::Recording read_whole_recording(const std::filesystem::path& file);

/// The same of what fits of laws take: time, ticks, positions, velocities and the force that counts, measured
/// where there is a sensor, else commanded. Every other column is left empty, and channels have no values.
[[nodiscard]] schema::Recording read_fitted_columns(const std::filesystem::path& file);

/// Lets go of the rows; what is said of them stays.
void drop_rows(schema::Recording& recording);

}  // namespace kerf::bench
