#pragma once

#include <filesystem>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Reads a recording for work that has to see all its rows at once, several times over.
/// @throws as schema::read_recording(); std::system_error (ENOMEM) before it begins where there is no memory
/// for so many rows.
[[nodiscard]] schema::Recording read_whole_recording(const std::filesystem::path& file);

}  // namespace kerf::bench
