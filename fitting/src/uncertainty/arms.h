#pragma once

#include <cstddef>
#include <vector>

#include "starts/search.h"

namespace kerf::fitting {

/// Parameters of an arm of a law, by their places; the first is its stiffness.
using Arm = std::vector<std::size_t>;
[[nodiscard]] std::vector<Arm> arms_of(const Problem& problem);

/// Whether a law without this arm, the rest fitted anew, leaves no more than chance would have it: twice the
/// logarithm of the ratio of the likelihoods, by as many samples as the residuals are worth, against
/// chi-squared of the arm's two parameters. Where both misfit, their residuals are worth next to no samples:
/// there it is the share that the arm explains that counts, 5 % of the sum of squares.
[[nodiscard]] bool does_without(const Arm& arm, const Problem& problem, const Samples& samples,
                                const Weights& weights, const Solution& solution, const RobustLoss& loss,
                                double independent_samples, double confidence);

}  // namespace kerf::fitting
