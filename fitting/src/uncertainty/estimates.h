#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// Fills in the parameters of a result with their uncertainty, its correlations, and the warnings that
/// follow.
void estimate_parameters(FitResult& result, const Problem& problem, const Samples& samples,
                         const Weights& weights, const Solution& solution, const FitOptions& options,
                         const RobustLoss& loss);

}  // namespace kerf::fitting
