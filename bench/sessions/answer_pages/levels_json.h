#pragma once

#include <nlohmann/json.hpp>

#include "answers/level_analysis.h"

namespace kerf::bench {

/// The ends of an interval; null where it is open.
[[nodiscard]] nlohmann::ordered_json pair_of(psychophysics::Interval interval);

/// Psychometric functions as they stand in the JSON of an analysis.
[[nodiscard]] nlohmann::ordered_json levels_as_json(const LevelAnalysis& levels, double confidence);

}  // namespace kerf::bench
