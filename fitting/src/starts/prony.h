#pragma once

#include <vector>

#include "starts/arm_sums.h"
#include "starts/scan.h"

namespace kerf::fitting {

/// Families of Maxwell's law: the best sets of relaxation times from a grid over the decades of the data,
/// each linear in its stiffnesses, best first. All subsets are judged from sums alone.
[[nodiscard]] std::vector<LinearFamily> prony_families(const Problem& problem, const Samples& samples,
                                                       const ArmProducts& products);
/// The same from the law itself on the samples.
[[nodiscard]] std::vector<LinearFamily> prony_families(const Problem& problem, const Samples& samples,
                                                       const Weights& weights);

}  // namespace kerf::fitting
