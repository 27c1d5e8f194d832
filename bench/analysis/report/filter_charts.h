#pragma once

#include "plot/plot.h"
#include "prepare/filter.h"

namespace kerf::bench {

/// Gain over frequency, and phase beneath it: two charts.
[[nodiscard]] Chart gain_chart(const FilterReport& report);
[[nodiscard]] Chart phase_chart(const FilterReport& report);

}  // namespace kerf::bench
