#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// Least squares of the law's own step. Which rows rupture is found where the force falls, and moved to where
/// least is left; given these the element is searched under the condition that a line over the speed
/// separates the forces that rupture from all others (rupture_cell.h), and the line is the one in the middle.
/// Where there is no such line the law itself is run, at lines beside the one that comes nearest.
[[nodiscard]] Solution solve_ruptures(const Problem& problem, const Samples& samples, const Weights& weights,
                                      const SearchOptions& options);

}  // namespace kerf::fitting
