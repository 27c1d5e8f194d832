#pragma once

#include <string>
#include <vector>

#include "import/import.h"

namespace kerf::bench {

/// Where the units of an import are in doubt, a sentence each that names what was mapped: a column whose
/// heading has another unit than the map gives it, whatever its factor, what has no unit that is known here
/// ("[counts]", "[dyn]") and is mapped to one as if they were the same, and what no hand and no tool of this
/// field does: a force beyond 200 N, a torque beyond 20 N·m, a way of more than 2 m or a whole turn, four
/// hours and more at less than 5 rows a second. Raw numbers that are mapped to "1" are not doubted.
[[nodiscard]] std::vector<std::string> unit_doubts(const Imported& imported);

}  // namespace kerf::bench
