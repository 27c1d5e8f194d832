#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "inspect/inspection.h"

namespace kerf::bench {

/// All of it, with "warnings"; what is not known is null.
[[nodiscard]] nlohmann::ordered_json inspection_as_json(const Inspection& inspection);

/// The same as lines for people, but for the warnings.
[[nodiscard]] std::vector<std::string> inspection_lines(const Inspection& inspection);

}  // namespace kerf::bench
