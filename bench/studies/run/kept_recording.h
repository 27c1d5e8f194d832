#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "run/studied_recording.h"

namespace kerf::bench {

/// What an earlier run left in `recordings/NAME`, if it was made of what the key stands for (of anything, if
/// the key is empty); nothing where there is none, or one that has to be made anew.
[[nodiscard]] std::optional<StudiedRecording> kept_recording(const std::filesystem::path& folder,
                                                             const std::string& key);

}  // namespace kerf::bench
