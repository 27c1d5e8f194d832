#pragma once

#include <optional>
#include <vector>

#include "cases/cases.h"
#include "cases/control_cost.h"
#include "stability/findings.h"

namespace kerf::bench {

[[nodiscard]] Findings findings_of(const std::vector<NamedCase>& cases,
                                   const std::optional<ControlCosts>& costs);

/// Whether every case fails without its remedy and holds with it.
[[nodiscard]] bool behave(const std::vector<NamedCase>& cases);

}  // namespace kerf::bench
