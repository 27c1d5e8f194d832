#pragma once

#include <string>
#include <vector>

#include "report/results/found_results.h"

namespace kerf::bench {

/// What its signals are worth, and what ought to be known before it is used.
[[nodiscard]] std::string inspection_section(const FoundResult& result);

/// Which law was chosen, why, and every candidate: error against parameters.
[[nodiscard]] std::string choice_section(const FoundResult& result);

/// Cost of a tick against error, with the front, as the chart itself draws it.
[[nodiscard]] std::string chart_section(const FoundResult& result);

/// What was found of a law's stability or of walls, with the map.
/// @throws std::invalid_argument for cells that are no grid.
[[nodiscard]] std::string stability_section(const FoundResult& result);

/// What a device is to a loop: of each axis the verdict, its numbers and its charts.
/// @throws std::invalid_argument for a chart that cannot be drawn.
[[nodiscard]] std::string device_section(const FoundResult& result);

/// What each law gave along the recording: errors, contacts, releases and drops, and its force over time as
/// far as the recordings of the laws lie beside the result. @throws schema::FormatError for one that is
/// damaged.
[[nodiscard]] std::string replay_section(const FoundResult& result);

// All throw nlohmann::json::exception if the JSON lacks what its verb writes.

/// From which file a result is, and whether that is of another recording, or does not say of which.
[[nodiscard]] std::string whose(const FoundResult& result);

/// The kinds that nobody has looked at, each with the command that makes one; empty if there are none. A
/// device is no part of a recording; fits and check have sections that say so themselves.
[[nodiscard]] std::string missing_section(const std::vector<FoundResult>& results,
                                          const std::string& recording);

}  // namespace kerf::bench
