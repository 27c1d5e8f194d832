#pragma once

#include <string>

#include "report/fit_view.h"

namespace kerf::bench {

/// Parameters of a law with their intervals, the correlations between those that were searched, profiles
/// where there are any, and warnings. `confidence` of the intervals.
[[nodiscard]] std::string parameter_part(const FittedTrace& trace, double confidence);

}  // namespace kerf::bench
