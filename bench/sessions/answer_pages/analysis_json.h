#pragma once

#include <nlohmann/json.hpp>

#include "answers/analysis.h"

namespace kerf::bench {

/// Everything about an analysis. "trials", "correct", "p_value", "ci95" and "dprime" are those of all
/// answers; of a preference "preferred" counts wins. A number that there is none of is null, and a "note"
/// beside it says why; an end of an interval that the answers leave open is null too.
[[nodiscard]] nlohmann::ordered_json analysis_as_json(const Analysis& analysis);

}  // namespace kerf::bench
