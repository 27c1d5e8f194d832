#pragma once

#include "problem.h"
#include "uncertainty/uncertainty.h"

namespace kerf::fitting {

/// Profile of the sum of squares for each coordinate: it is held at one value after another, outwards from
/// the best in steps of half a standard error, while the others follow. With S the sum of squares and u its
/// curvature's standard error,
///
///     deviation = sign sqrt((S - S_best) / c),   c such that near the best one standard error gives 1,
///
/// so that the profile allows for the residuals' correlation as the interval does, but not for a parabola.
/// Source: [BatesWatts1988], section 6.1.
[[nodiscard]] std::vector<Profile> profiles_of(const Problem& problem, const Samples& samples,
                                               const Weights& weights, const Values& best,
                                               const RobustLoss& loss, const Uncertainty& uncertainty,
                                               const std::vector<std::string>& names);

}  // namespace kerf::fitting
