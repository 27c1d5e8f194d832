#pragma once

#include "starts/search.h"
#include "uncertainty/uncertainty.h"

namespace kerf::fitting {

/// Residuals and derivatives of a solution: the rows that count, times the roots of their weights.
[[nodiscard]] Linearisation linearise(const LawObjective& objective, const Problem& problem,
                                      const Solution& solution, const Samples& samples,
                                      const Weights& weights, const RobustLoss& loss);

/// s^2 (J'J)^-1, from the search's own sums where it searched the same coordinates.
[[nodiscard]] Uncertainty as_of_white_noise(const LawObjective& objective, const Eigen::VectorXd& at,
                                            const Solution& solution, const Weights& weights,
                                            double confidence);

}  // namespace kerf::fitting
