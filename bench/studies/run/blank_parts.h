#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "fits/fit_recording.h"
#include "run/studied_recording.h"

namespace kerf::bench {

/// A recording before its blank was taken off, and what is to be known of it.
struct BeforeBlank {
  const schema::Recording* recording = nullptr;  ///< with the cycles and flags that it has afterwards
  std::filesystem::path blank;                   ///< the recording that was taken off
  std::size_t axis = 0;
  FitRecordingOptions options;  ///< of its fits
};

/// A quantity of a study by its name, "peak", "work" or "kelvin.damping"; NaN: it could not be found.
using QuantityValues = std::map<std::string, double>;

/// What the study takes from a recording with one part of its blank's cycles left out after the other, in as
/// many parts as there are cycles, ten at most: what is to be known of the error of the blank, which all
/// recordings share that it is taken off. Laws are those that were fitted, found anew.
/// @throws std::system_error if it was stopped, or the blank cannot be read.
[[nodiscard]] std::vector<QuantityValues> without_parts(const BeforeBlank& before,
                                                        const StudiedRecording& result, bool all_cycles);

}  // namespace kerf::bench
