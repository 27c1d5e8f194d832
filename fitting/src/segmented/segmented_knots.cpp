#include "segmented/segmented_knots.h"

#include <algorithm>

namespace kerf::fitting::segmented {
namespace {

constexpr double open = 1e-13;  ///< share of a pivot below which the points leave a force open

/// Normal equations of the forces of one branch: tridiagonal, as L D L'.
struct Tridiagonal {
  std::array<double, max_segments + 1> diagonal{}, beside{}, factor{}, inverse_pivot{};
  std::size_t size = 0;
  bool determined = true;

  void decompose() {
    double above = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      if (i > 0) {
        factor[i] = beside[i - 1] * inverse_pivot[i - 1];
        above = factor[i] * beside[i - 1];
      }
      const double pivot = diagonal[i] - above;
      const bool known = pivot > open * diagonal[i];
      determined = determined && known;
      inverse_pivot[i] = known ? 1.0 / pivot : 0.0;
    }
  }
  void solve(std::array<double, max_segments + 1>& right) const {
    for (std::size_t i = 1; i < size; ++i) right[i] -= factor[i] * right[i - 1];
    for (std::size_t i = 0; i < size; ++i) right[i] *= inverse_pivot[i];
    for (std::size_t i = size - 1; i-- > 0;) right[i] -= factor[i + 1] * right[i + 1];
  }
};

/// One branch under given knots.
struct Fit {
  std::array<Moments, max_segments> moments;
  std::array<Line, max_segments> lines{};
  Tridiagonal normal;
  std::array<double, max_segments + 1> force{};

  Fit(const Branch& branch, const std::vector<double>& knots) {
    const std::size_t segments = knots.size() - 1;
    normal.size = knots.size();
    for (std::size_t i = 0; i < segments; ++i) {
      const Branch::Stretch& stretch = branch.stretch(knots[i], knots[i + 1]);
      moments[i] = stretch.moments;
      lines[i] = stretch.line;
      const Line& line = lines[i];
      normal.diagonal[i] += line.near;
      normal.diagonal[i + 1] += line.far;
      normal.beside[i] = line.cross;
      force[i] += line.near * line.p0 + line.cross * line.q0;
      force[i + 1] += line.cross * line.p0 + line.far * line.q0;
    }
    normal.decompose();
    normal.solve(force);
  }

  [[nodiscard]] double slope(std::size_t i, const std::vector<double>& knots) const {
    return (force[i + 1] - force[i]) / (knots[i + 1] - knots[i]);
  }
  /// Of the points of a segment about its line, as a sum without differences.
  [[nodiscard]] double error(std::size_t i, const std::vector<double>& knots) const {
    const Moments& m = moments[i];
    if (m.weight == 0.0) return 0.0;
    const double best = m.xx > 0.0 ? m.xy / m.xx : 0.0;
    const double tilt = slope(i, knots) - best;
    const double miss = m.y - force[i] - slope(i, knots) * (m.x - knots[i]);
    return lines[i].error + m.xx * tilt * tilt + m.weight * miss * miss;
  }
  /// Moving a knot changes the curve, but for what the forces can undo, by the change of slope there times
  /// the falling part of the knot's hat function, on the segment after it.
  void add_to(Sensitivity& sensitivity, const std::vector<double>& knots) const {
    const std::size_t inner = knots.size() - 2;
    std::array<std::array<double, max_segments + 1>, max_segments> hats{};  // products with the hat functions
    std::array<double, max_segments> bend{};
    for (std::size_t i = 0; i < inner; ++i) {
      const std::size_t after = i + 1;
      bend[i] = slope(after, knots) - slope(i, knots);
      const Moments& m = moments[after];
      const double length = knots[after + 1] - knots[after];
      const double miss = m.y - force[after] - slope(after, knots) * (m.x - knots[after]);
      const double tilt = m.xy - slope(after, knots) * m.xx;
      const double falling = m.weight * ((knots[after + 1] - m.x) / length) * miss - tilt / length;
      const auto at = static_cast<Eigen::Index>(i);
      sensitivity.gradient[at] += bend[i] * falling;
      sensitivity.normal(at, at) += bend[i] * bend[i] * lines[after].near;
      hats[i][after] = bend[i] * lines[after].near;
      hats[i][after + 1] = bend[i] * lines[after].cross;
    }
    for (std::size_t i = 0; i < inner; ++i) {
      auto undone = hats[i];
      normal.solve(undone);
      for (std::size_t j = 0; j < inner; ++j) {
        sensitivity.normal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) -=
            hats[j][j + 1] * undone[j + 1] + hats[j][j + 2] * undone[j + 2];
      }
    }
  }
};

}  // namespace

bool allowed(const Points& points, const std::vector<double>& knots, std::size_t fewest_points) {
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    if (!(knots[i + 1] - knots[i] >= least_gap)) return false;
  }
  return std::all_of(points.branches.begin(), points.branches.end(), [&](const Branch& branch) {
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const Branch::Stretch& stretch = branch.stretch(knots[i], knots[i + 1]);
      if (!branch.supports(stretch.first, stretch.last, fewest_points)) return false;
    }
    return true;
  });
}

Forces best_forces(const Points& points, const std::vector<double>& knots, Sensitivity* sensitivity) {
  Forces forces;
  if (sensitivity != nullptr) {
    const auto inner = static_cast<Eigen::Index>(knots.size() - 2);
    sensitivity->gradient.setZero(inner);
    sensitivity->normal.setZero(inner, inner);
  }
  for (std::size_t branch = 0; branch < points.branches.size(); ++branch) {
    const Fit fit(points.branches[branch], knots);
    forces.at_knot[branch] = fit.force;
    forces.determined = forces.determined && fit.normal.determined;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) forces.error += fit.error(i, knots);
    if (sensitivity != nullptr) fit.add_to(*sensitivity, knots);
  }
  return forces;
}

}  // namespace kerf::fitting::segmented
