#pragma once

#include <cmath>

#include "segmented/segmented_moments.h"

namespace kerf::fitting::segmented {

/// Knots that are closer in scaled positions would make a slope of mere rounding.
constexpr double least_gap = 1e-9;

/// Squared error of the points between two knots about the line from force p at the one to q at the other:
///
///     error + near (p - p0)^2 + 2 cross (p - p0) (q - q0) + far (q - q0)^2
///
/// with the best line from p0 to q0.
struct Line {
  double near = 0.0, cross = 0.0, far = 0.0;
  double determinant = 0.0;  ///< near far - cross^2, without the cancellation
  double p0 = 0.0, q0 = 0.0;
  double error = 0.0;
};

[[nodiscard]] inline Line line_between(const Moments& points, double from, double to) noexcept {
  const double length = to - from;
  const double t = (points.x - from) / length;
  const double s = (to - points.x) / length;
  const double lever = points.xx / (length * length);
  const double slope = points.xx > 0.0 ? points.xy / points.xx * length : 0.0;
  return {
      .near = points.weight * s * s + lever,
      .cross = points.weight * s * t - lever,
      .far = points.weight * t * t + lever,
      .determinant = points.weight * lever,
      .p0 = points.y - slope * t,
      .q0 = points.y + slope * s,
      .error = points.xx > 0.0 ? std::fmax(0.0, points.yy - points.xy * (points.xy / points.xx)) : points.yy};
}

}  // namespace kerf::fitting::segmented
