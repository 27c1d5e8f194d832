#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// For each depth at which the tissue may have yielded the exponential before it and the constant force after
/// it; the depth of least squares wins, on a grid first and then between its neighbours.
[[nodiscard]] Solution solve_fracture(const Problem& problem, const Samples& samples, const Weights& weights,
                                      const Values& near, const RobustLoss& loss);

/// Ruptures are drops of the force by more than half of it within 20 ms while the tool goes on. Between them
/// the Kelvin element is fitted as runs of their own; their forces over the speed are the threshold, a line.
[[nodiscard]] Solution solve_ruptures(const Problem& problem, const Samples& samples, const Weights& weights);

}  // namespace kerf::fitting
