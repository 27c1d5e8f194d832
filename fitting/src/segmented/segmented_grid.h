#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "segmented/segmented_points.h"

namespace kerf::fitting::segmented {

/// Where knots may be, and what is known beforehand.
struct Grid {
  std::vector<double> places;  ///< increasing scaled positions from 0 to 1
  std::size_t max_segments = 1;
  std::size_t fewest_points = 1;  ///< in a segment, on each branch
  std::size_t beam = 64;          ///< paths kept at a place, where there are two branches or windows
  /// For each number of segments an error that can be reached on this grid, or infinity; index 0 unused.
  std::vector<double> reachable;
  /// If not empty: the first and last place that each of the max_segments - 1 inner knots may take, and only
  /// max_segments are searched.
  std::vector<std::pair<std::size_t, std::size_t>> windows;
};

/// The best path over the grid; no knots if there is none.
struct GridPath {
  std::vector<double> knots;
  double error = 0.0;    ///< scaled sum of squares
  bool optimal = false;  ///< proven
};

/// The best path for every number of segments from 1 to max_segments, at index number - 1; with windows, for
/// max_segments alone.
[[nodiscard]] std::vector<GridPath> search_grid(const Points& points, const Grid& grid);

}  // namespace kerf::fitting::segmented
