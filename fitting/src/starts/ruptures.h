#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// Ruptures are drops of the force by more than half of it within 20 ms while the tool goes on. Between them
/// the Kelvin element is fitted as runs of their own; their forces over the speed are the threshold, a line.
[[nodiscard]] Solution solve_ruptures(const Problem& problem, const Samples& samples, const Weights& weights);

}  // namespace kerf::fitting
