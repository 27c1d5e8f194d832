#pragma once

#include <vector>

#include "solve.h"

namespace kerf::fitting {

/// Starts for Kelvin and exponential: for each of a row of values of the one nonlinear parameter, the others
/// follow by linear least squares on the law's own step; the three best come first.
[[nodiscard]] std::vector<std::vector<double>> scan_starts(const Problem& problem, const Samples& samples,
                                                           const Mask& mask);

/// A start for piecewise: the globally best breakpoints on a fine grid of the penetration (a line a segment,
/// by dynamic programming over sums of the samples in each cell), with the forces that fit them best under
/// continuity. Too few samples for as many segments: an empty start.
[[nodiscard]] std::vector<double> segmented_start(const Problem& problem, const Samples& samples,
                                                  const Mask& mask);

}  // namespace kerf::fitting
