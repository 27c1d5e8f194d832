#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/schema/recorded_rows.h>

#include "report/results/found_results.h"

namespace kerf::bench {

/// Tells of each result of this recording whether it is of the state that the recording is in now.
void tell_states(std::vector<FoundResult>& results, const schema::RecordedRows& rows);

/// Of a result that is not: "of earlier cycles: run kerf fit again".
[[nodiscard]] std::string outdated_in_words(const FoundResult& result);

/// Where fits and charts of this recording take the tissue to begin at different places, so that their laws
/// are others; empty where they do not, or do not say.
[[nodiscard]] std::string contacts_apart(const std::vector<FoundResult>& results,
                                         const schema::Recording& about, std::size_t axis);

}  // namespace kerf::bench
