#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// Least squares of the law's own step, cracks that run ahead of the tool and further fractures and all.
/// Looks at depths of yielding and cracks over all that the tool's path allows, amplitude and exponent at
/// their best for each; goes on from those that leave least and lie apart to their neighbours, and descends
/// where no row changes sides (fracture_cells.h). Where it went on from and did not end is kept, as rivals.
[[nodiscard]] Solution solve_fracture(const Problem& problem, const Samples& samples, const Weights& weights,
                                      const Values& near, const SearchOptions& options);

}  // namespace kerf::fitting
