#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "prepare/prepare.h"

namespace kerf::bench {

/// The JSON of `kerf prepare`.
[[nodiscard]] nlohmann::ordered_json prepared_as_json(const Prepared& prepared);

/// Its steps for people, with the response of the filter and the score.
[[nodiscard]] std::vector<std::string> prepared_lines(const Prepared& prepared);

}  // namespace kerf::bench
