#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// Laws that are found in stages, because their force jumps where tissue breaks: fracture, fuzzy_kelvin; and
/// fuzzy_rupture, whose memberships are trained (rupture.h).
[[nodiscard]] bool is_staged(std::string_view model);

/// Options that follow from the data: the box of a rupture threshold, the number of its memberships.
void prepare_staged(std::string_view model, models::Options& options, const Samples& samples);

/// Holds the parameters that no recording along one axis can tell (the width of the blade, say).
void hold_unsearched(Problem& problem);

/// Fracture: for each depth at which the tissue may have yielded the exponential before it and the constant
/// force after it; the depth of least squares wins, on a grid first and then between its neighbours.
///
/// Fuzzy Kelvin: ruptures are drops of the force by more than half of it within 20 ms while the tool goes on.
/// Between them the Kelvin element is fitted as runs of their own; their forces over the speed are the
/// threshold, a line.
[[nodiscard]] Solution solve_staged(const Problem& problem, const Samples& samples, const Weights& weights,
                                    const Values& near, const RobustLoss& loss);

/// What a warning says of a staged law's fit.
[[nodiscard]] std::string staged_note(const Problem& problem);

}  // namespace kerf::fitting
