#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "import/import.h"

namespace kerf::bench {

/// The JSON of `kerf import`.
[[nodiscard]] nlohmann::ordered_json imported_as_json(const Imported& imported);

/// How the text was understood: its layout, and which column became what, in which unit.
[[nodiscard]] std::vector<std::string> imported_lines(const Imported& imported);

}  // namespace kerf::bench
