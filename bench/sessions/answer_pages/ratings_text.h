#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "answers/ratings.h"

namespace kerf::bench {

/// How sure answers were, as JSON and as a table of a page.
[[nodiscard]] nlohmann::ordered_json ratings_as_json(const RatingAnalysis& analysis);
[[nodiscard]] std::string rating_section(const RatingAnalysis& analysis);

}  // namespace kerf::bench
