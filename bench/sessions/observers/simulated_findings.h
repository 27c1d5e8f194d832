#pragma once

#include <vector>

#include "observers/simulate.h"

namespace kerf::bench {

/// Sums up what experiments found. `level`: of their tests.
[[nodiscard]] SimulatedFindings findings_of(const std::vector<MainResult>& results,
                                            const SimulatedTruth& truth, double level);

}  // namespace kerf::bench
