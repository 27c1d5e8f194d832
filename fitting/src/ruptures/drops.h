#pragma once

#include <vector>

#include "samples.h"

namespace kerf::fitting {

/// Rows at which tissue ruptures, in order.
using RuptureRows = std::vector<std::size_t>;

/// Where the force falls by half or more within 20 ms while the tool goes on, and by more than noise does, at
/// once or on average: of these rows the one at which it falls most.
[[nodiscard]] RuptureRows drops_of(const Samples& samples, const Weights& weights);

/// By how much the force falls at a row: at once, or from the 20 ms before to those after, whichever is more.
[[nodiscard]] double drop_at(const Samples& samples, std::size_t row);

}  // namespace kerf::fitting
