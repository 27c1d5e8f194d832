#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "run/studied_recording.h"

namespace kerf::bench {

/// Why no law of one axis can be fitted to a recording of several; empty: one can.
/// @param named axis that its [[file]] names; empty: none
[[nodiscard]] std::string why_no_axis(const schema::Recording& recording, const std::string& named);

/// Fits the law `blade` to a recording of six axes that is written in a folder, and writes
/// fits/blade.law.toml there; or says why it is not fitted. Nothing of a recording that has not six axes.
/// @param shape law file with the blade's polygons and edge; empty: the study names none
/// @param warnings what the fit says beside it goes there
[[nodiscard]] std::optional<StudiedBlade> fit_blade_in_study(const schema::Recording& recording,
                                                             const std::filesystem::path& shape,
                                                             const std::filesystem::path& folder,
                                                             std::vector<std::string>& warnings);

}  // namespace kerf::bench
