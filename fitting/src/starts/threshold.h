#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// The threshold at which tissue ruptures as a force of its own: its memberships are trained (rupture.h).
[[nodiscard]] Solution solve_threshold(const Problem& problem, const Samples& samples,
                                       const Weights& weights);

}  // namespace kerf::fitting
