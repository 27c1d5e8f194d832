#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// Least squares of the law's own step, cracks that run ahead of the tool and further fractures and all.
/// Begins with the exponential before each depth at which the tissue may have yielded, and the force of
/// cutting or a crack of some length after it; descends where no row changes sides, and looks beside for
/// other rows that break (fracture_events.h).
[[nodiscard]] Solution solve_fracture(const Problem& problem, const Samples& samples, const Weights& weights,
                                      const Values& near, const SearchOptions& options);

}  // namespace kerf::fitting
