#pragma once

#include <string>

#include "plot/plot.h"
#include "prepare/filter.h"

namespace kerf::bench {

/// Gain over frequency, and phase beneath it.
[[nodiscard]] Chart gain_chart(const FilterReport& report);
[[nodiscard]] Chart phase_chart(const FilterReport& report);

/// Both as one drawing.
[[nodiscard]] std::string filter_response_svg(const FilterReport& report);

}  // namespace kerf::bench
