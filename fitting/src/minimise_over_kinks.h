#pragma once

#include "least_squares.h"

namespace kerf::fitting {

/// From where a search stands still though no minimum is there: a law that only pushes, met by a force that
/// is not zero where it begins to, has a sum of squares with a kink for every such sample, and each may hold
/// a search up. Steps of Newton by scores averaged over neighbourhoods that hold many kinks, smaller and
/// smaller ones; the least sum of squares that was seen.
[[nodiscard]] Minimum step_over_kinks(const Minimum& from, const Objective& objective, const Bounds& bounds);

}  // namespace kerf::fitting
