#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <kerf/models/piecewise.h>

#include "segmented/segmented_points.h"

namespace kerf::fitting::segmented {

inline constexpr std::size_t max_segments = models::Piecewise<double>::max_segments;

/// The best forces at given knots, and the error they leave, all scaled.
struct Forces {
  std::array<std::array<double, max_segments + 1>, 2> at_knot{};
  double error = 0.0;
  bool determined = true;  ///< no knot whose force the points leave open
};

/// How the error changes with the inner knots if the forces follow (variable projection after Kaufman):
/// half its gradient, and half its second derivatives without those of the residuals.
struct Sensitivity {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_segments, max_segments>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_segments, 1>;
  Vector gradient;
  Matrix normal;
};

/// Whether the knots keep their order and distance and leave each segment its points on each branch.
[[nodiscard]] bool allowed(const Points& points, const std::vector<double>& knots, std::size_t fewest_points);

[[nodiscard]] Forces best_forces(const Points& points, const std::vector<double>& knots,
                                 Sensitivity* sensitivity = nullptr);

}  // namespace kerf::fitting::segmented
