#pragma once

#include <vector>

#include "observers/simulate.h"

namespace kerf::bench {

/// One more experiment.
void count(SimulatedShare& share, bool is_so);

/// Sums up what experiments found. `level`: of their tests.
[[nodiscard]] SimulatedFindings findings_of(const std::vector<MainResult>& results,
                                            const SimulatedTruth& truth, double level);

}  // namespace kerf::bench
