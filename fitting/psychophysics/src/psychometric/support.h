#pragma once

#include "psychometric/likelihood.h"

namespace kerf::psychophysics {

/// A box in threshold, log of the slope and lapse rate, within the bounds of a problem.
struct Support {
  Point lower{};
  Point upper{};
  double largest = 0.0;  ///< log-likelihood
};

/// The box about all points whose log-likelihood is within 20 of the largest: of a posterior under a flat
/// prior it holds all but 1e-8. Its ends are those of the profiles, and no less than what a scan over the
/// bounds finds.
[[nodiscard]] Support support_of(const Problem& problem, const Held& held);

}  // namespace kerf::psychophysics
