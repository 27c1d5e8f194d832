#pragma once

#include <vector>

#include "segmented/segmented_points.h"
#include "segmented/segmented_polish.h"

namespace kerf::fitting::segmented {

/// The best knots for one number of segments, scaled.
struct Found {
  Polished best;
  double error_on_grid = 0.0;
  bool optimal_on_grid = false;
};

/// For every number of segments from 1 on that the points carry: the optimum on the grid, then polished from
/// there, from a grid that follows the points, and from the neighbouring numbers' curves.
[[nodiscard]] std::vector<Found> search(const Points& points, const SegmentedOptions& options);

}  // namespace kerf::fitting::segmented
