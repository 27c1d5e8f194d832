#include "prepare/hinge.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace kerf::bench {
namespace {

/// Sums of samples, from which least squares over any of them follow.
struct Sums {
  double n = 0.0, u = 0.0, y = 0.0, uu = 0.0, uy = 0.0, yy = 0.0;

  void add(double u_value, double y_value, double sign = 1.0) noexcept {
    n += sign;
    u += sign * u_value;
    y += sign * y_value;
    uu += sign * u_value * u_value;
    uy += sign * u_value * y_value;
    yy += sign * y_value * y_value;
  }
};

struct Candidate {
  Hinge hinge;
  double squares = std::numeric_limits<double>::infinity();
};

/// Level and slope with the corner held at `corner`, where `after` are the samples beyond it.
Candidate with_corner(double corner, const Sums& before, const Sums& after) {
  const double n = before.n + after.n;
  const double ramp = after.u - after.n * corner;
  const double ramp_squared = after.uu - 2.0 * corner * after.u + after.n * corner * corner;
  const double ramp_y = after.uy - corner * after.y;
  const double y = before.y + after.y;
  const double determinant = n * ramp_squared - ramp * ramp;
  if (!(determinant > 1e-14 * n * ramp_squared)) return {};
  Candidate candidate;
  candidate.hinge.corner = corner;
  candidate.hinge.slope = (n * ramp_y - ramp * y) / determinant;
  candidate.hinge.level = (y - candidate.hinge.slope * ramp) / n;
  candidate.squares = before.yy + after.yy - candidate.hinge.level * y - candidate.hinge.slope * ramp_y;
  if (!(candidate.hinge.slope > 0.0)) candidate.squares = std::numeric_limits<double>::infinity();
  return candidate;
}

/// The crossing of the level before and the free line after.
double crossing(const Sums& before, const Sums& after) {
  const double determinant = after.n * after.uu - after.u * after.u;
  const double slope = (after.n * after.uy - after.u * after.y) / determinant;
  const double offset = (after.y - slope * after.u) / after.n;
  return (before.y / before.n - offset) / slope;
}

/// From the curvature of the squares in level, slope and corner.
double error_of_corner(const Hinge& hinge, const Sums& before, const Sums& after, double squares) {
  const double n = before.n + after.n;
  const double variance = std::max(squares, 0.0) / std::max(n - 3.0, 1.0);
  const double ramp = after.u - after.n * hinge.corner;
  const double ramp_squared = after.uu - 2.0 * hinge.corner * after.u + after.n * hinge.corner * hinge.corner;
  // Columns: 1; the ramp; -slope beyond the corner. What of the last is beside the first two counts.
  const double s = hinge.slope;
  const double a = n, b = ramp, d = ramp_squared, c1 = -s * after.n, c2 = -s * ramp, c3 = s * s * after.n;
  const double determinant = a * d - b * b;
  const double information = c3 - (c1 * (d * c1 - b * c2) + c2 * (a * c2 - b * c1)) / determinant;
  return information > 0.0 ? std::sqrt(variance / information) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Hinge fit_hinge(std::span<const double> u, std::span<const double> y) {
  const std::size_t count = u.size();
  if (count < 5) return {};
  // Shifted to the first sample: times far from zero would spoil the sums.
  const double u0 = u.front();
  const double y0 = y.front();
  Sums before;
  Sums after;
  for (std::size_t i = 0; i < count; ++i) after.add(u[i] - u0, y[i] - y0);
  const double level_squares = after.yy - after.y * after.y / after.n;
  Candidate best;
  Sums best_before;
  Sums best_after;
  const auto consider = [&](double corner) {
    const Candidate candidate = with_corner(corner, before, after);
    if (!(candidate.squares < best.squares)) return;
    best = candidate;
    best_before = before;
    best_after = after;
  };
  // At least two samples on either side.
  for (std::size_t i = 0; i + 2 < count; ++i) {
    before.add(u[i] - u0, y[i] - y0);
    after.add(u[i] - u0, y[i] - y0, -1.0);
    if (i == 0) continue;
    consider(u[i] - u0);
    const double between = crossing(before, after);
    if (between > u[i] - u0 && between < u[i + 1] - u0) consider(between);
  }
  if (!(best.squares < level_squares)) return {};
  Hinge hinge = best.hinge;
  hinge.corner_error = error_of_corner(hinge, best_before, best_after, best.squares);
  hinge.corner += u0;
  hinge.level += y0;
  hinge.found = true;
  return hinge;
}

}  // namespace kerf::bench
