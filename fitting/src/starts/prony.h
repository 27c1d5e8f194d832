#pragma once

#include <vector>

#include "starts/scan.h"

namespace kerf::fitting {

/// Families of Maxwell's law: the best sets of relaxation times from a grid over the decades of the data,
/// each linear in its stiffnesses. All subsets are judged from the sums of one dictionary of arms.
[[nodiscard]] std::vector<LinearFamily> prony_families(const Problem& problem, const Samples& samples,
                                                       const Weights& weights);

}  // namespace kerf::fitting
