#pragma once

#include <span>
#include <vector>

#include "stability/controllers/wall_controller.h"

namespace kerf::bench {

/// What a step of each controller costs [ns], in their order: the time between two stamps() with it, less
/// that with nothing between them. They take turns, round by round, along the same motion; each cost is the
/// lowest tenth of its medians, as that of laws is (tick_costs()).
[[nodiscard]] std::vector<double> controller_costs(std::span<const ControllerDesign> designs,
                                                   const Wall& wall);

}  // namespace kerf::bench
