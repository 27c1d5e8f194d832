#pragma once

#include <cstddef>
#include <string>

#include <kerf/schema/recorded_rows.h>

#include "report/results.h"

namespace kerf::bench {

/// What a recording is worth: its signals, its cycles with their flags, and the flagged ones drawn on the
/// data.
[[nodiscard]] std::string inspection_section(const FoundResult& result, const schema::RecordedRows& rows,
                                             std::size_t axis);

/// Which law was chosen, why, and every candidate.
[[nodiscard]] std::string choice_section(const FoundResult& result);

/// Cost of a tick against error, with the front.
[[nodiscard]] std::string chart_section(const FoundResult& result);

/// What was found of a law's stability, the map, and of each condition whether it is necessary or sufficient.
[[nodiscard]] std::string stability_section(const FoundResult& result);

/// What each law gave along the recording: errors, contacts, releases and drops.
[[nodiscard]] std::string replay_section(const FoundResult& result);

// All throw nlohmann::json::exception if the JSON lacks what its verb writes.

/// That a result is of another recording, or does not say whose it is; empty if it is of this one.
[[nodiscard]] std::string whose(const FoundResult& result);

/// The kinds that nobody has looked at, each with the command that makes one; empty if there are none. Fits
/// and check have sections that say so themselves.
[[nodiscard]] std::string missing_section(const std::vector<FoundResult>& results,
                                          const std::string& recording);

}  // namespace kerf::bench
