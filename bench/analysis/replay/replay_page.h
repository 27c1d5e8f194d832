#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "plot/plot.h"
#include "replay/open_loop.h"

namespace kerf::bench {

/// Recorded and rendered forces over time, and under it what lies between them in JNDs; one pair of charts
/// for each axis that a law acts on.
[[nodiscard]] std::vector<Chart> replay_charts(const Source& source, const OpenLoopResult& result);

/// One page with the charts and the tables of forces and events.
[[nodiscard]] std::string replay_page(const nlohmann::ordered_json& json,
                                      const std::vector<std::string>& charts);

}  // namespace kerf::bench
