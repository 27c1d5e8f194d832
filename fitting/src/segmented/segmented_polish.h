#pragma once

#include <cstddef>
#include <vector>

#include "segmented/segmented_points.h"

namespace kerf::fitting::segmented {

/// Knots with the error that their best forces leave, scaled.
struct Polished {
  std::vector<double> knots;
  double error = 0.0;
  bool converged = true;
  int iterations = 0;
};

/// Moves the inner knots to the nearest least error, by Gauss-Newton steps alone. Never worse.
[[nodiscard]] Polished descend(const Points& points, const std::vector<double>& knots,
                               std::size_t fewest_points);

/// The same by turns with a search among the points around each knot, all knots at once, until neither gains.
/// `cell` is the widest step that is tried [scaled]; what stays above the bound is not looked
/// at. Never worse.
[[nodiscard]] Polished settle(const Points& points, const Polished& start, std::size_t fewest_points,
                              double cell, double bound);

/// Between any two neighbouring points there may be a least error of its own: tries the nearest such
/// intervals for each knot, with a few Gauss-Newton steps of all knots from there. Never worse.
[[nodiscard]] Polished relocate(const Points& points, const Polished& start, std::size_t fewest_points);

}  // namespace kerf::fitting::segmented
