#pragma once

#include <limits>
#include <vector>

#include "editor/segment_editor.h"

namespace kerf::test {

inline constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

inline double line(const bench::Knots& knots, const std::vector<double>& force, double x) {
  std::size_t i = 0;
  while (i + 2 < knots.penetration.size() && knots.penetration[i + 1] < x) ++i;
  const double share = (x - knots.penetration[i]) / (knots.penetration[i + 1] - knots.penetration[i]);
  return force[i] + share * (force[i + 1] - force[i]);
}

/// 20 mm, closing up to 10 N and opening against 2 N, with its breaks on points of the curve.
inline bench::Knots loop_of_four() {
  return {.penetration = {0.0, 0.004, 0.012, 0.02},
          .closing = {1.0, 4.0, 3.0, 10.0},
          .opening = {-2.0, -1.0, -1.0, 2.0}};
}

/// The averaged cycle that a law itself would give.
inline bench::EditorCurve curve_along(const bench::Knots& knots, std::size_t points = 101) {
  bench::EditorCurve curve{
      .axis = "x_s", .position_unit = "m", .force_unit = "N", .cycles = 8, .contact = {}};
  for (std::size_t i = 0; i < points; ++i) {
    const double x = knots.penetration.back() * static_cast<double>(i) / static_cast<double>(points - 1);
    curve.penetration.push_back(x);
    curve.closing.push_back(line(knots, knots.closing, x));
    curve.opening.push_back(knots.opening.empty() ? nothing : line(knots, knots.opening, x));
  }
  return curve;
}

}  // namespace kerf::test
