#include "segments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <kerf/models/branch.h>

#include "least_squares.h"

namespace kerf::fitting {
namespace {

constexpr std::size_t cells = 256;
constexpr double fewest_samples = 4.0;  ///< of a segment, on each branch

/// Sums of the samples of a stretch of cells, from which the best line's squared error follows.
struct Sums {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void add(double px, double py) {
    n += 1.0;
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
    yy += py * py;
  }
  [[nodiscard]] Sums minus(const Sums& other) const {
    return {n - other.n, x - other.x, y - other.y, xx - other.xx, xy - other.xy, yy - other.yy};
  }
  [[nodiscard]] Sums plus(const Sums& other) const {
    return {n + other.n, x + other.x, y + other.y, xx + other.xx, xy + other.xy, yy + other.yy};
  }
  /// Sum of squares about the best line.
  [[nodiscard]] double error() const {
    if (n < 1.0) return 0.0;
    const double vx = xx - x * x / n;
    const double vy = yy - y * y / n;
    const double vxy = xy - x * y / n;
    return std::max(0.0, vx > 1e-18 * xx ? vy - vxy * vxy / vx : vy);
  }
};

/// Prefix sums over the cells, one set a branch; offsets keep the differences exact enough.
std::vector<std::vector<Sums>> prefix_sums(const Samples& samples, const Mask& mask, bool loop) {
  std::vector<std::vector<Sums>> branches;
  for (const bool closing : {true, false}) {
    if (!closing && !loop) break;
    const auto mine = on_branch(samples, {.loop = loop, .closing = closing});
    std::vector<Sums> sums(cells + 1);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!mask[i] || !mine[i]) continue;
      const double place = (samples.motion[i].penetration - samples.least) / (samples.most - samples.least);
      const auto cell = std::min(cells - 1, static_cast<std::size_t>(place * static_cast<double>(cells)));
      sums[cell + 1].add(place, samples.force[i]);
    }
    for (std::size_t cell = 0; cell < cells; ++cell) sums[cell + 1] = sums[cell + 1].plus(sums[cell]);
    branches.push_back(std::move(sums));
  }
  return branches;
}

double error_between(const std::vector<std::vector<Sums>>& branches, std::size_t from, std::size_t to) {
  double error = 0.0;
  for (const auto& sums : branches) {
    const Sums stretch = sums[to].minus(sums[from]);
    if (stretch.n < fewest_samples) return std::numeric_limits<double>::infinity();
    error += stretch.error();
  }
  return error;
}

}  // namespace

std::vector<bool> on_branch(const Samples& samples, const BranchOf& branch) {
  std::vector<bool> mine(samples.size(), true);
  if (!branch.loop) return mine;
  const models::BranchSelector selector;
  models::BranchSelector::State state;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    mine[i] = selector.step(state, samples.motion[i], samples.period_s[i]).closing == branch.closing;
  }
  return mine;
}

std::vector<double> best_knots(const Samples& samples, const Mask& mask, std::size_t segments, bool loop) {
  const auto branches = prefix_sums(samples, mask, loop);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  // best[s][end]: least error of the cells before `end` in s segments; from[s][end]: where the last one
  // begins.
  std::vector<std::vector<double>> best(segments + 1, std::vector<double>(cells + 1, infinite));
  std::vector<std::vector<std::size_t>> from(segments + 1, std::vector<std::size_t>(cells + 1, 0));
  best[0][0] = 0.0;
  for (std::size_t s = 1; s <= segments; ++s) {
    for (std::size_t end = s; end <= cells; ++end) {
      for (std::size_t begin = s - 1; begin < end; ++begin) {
        if (best[s - 1][begin] == infinite) continue;
        const double error = best[s - 1][begin] + error_between(branches, begin, end);
        if (error < best[s][end]) {
          best[s][end] = error;
          from[s][end] = begin;
        }
      }
    }
  }
  if (best[segments][cells] == infinite) return {};
  std::vector<double> knots(segments + 1);
  std::size_t cell = cells;
  for (std::size_t s = segments + 1; s-- > 0;) {
    knots[s] = samples.least +
               (samples.most - samples.least) * static_cast<double>(cell) / static_cast<double>(cells);
    if (s > 0) cell = from[s][cell];
  }
  knots.back() = samples.most;
  return knots;
}

HatEquations hat_equations(const Samples& samples, const Mask& mask, const std::vector<double>& knots,
                           const BranchOf& branch) {
  const auto mine = on_branch(samples, branch);
  const auto count = static_cast<Eigen::Index>(knots.size());
  HatEquations equations{.normal = Eigen::MatrixXd::Zero(count, count),
                         .right = Eigen::VectorXd::Zero(count)};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!mask[i] || !mine[i]) continue;
    // As the laws do it: held before the first knot, and the last trend goes on past the last one.
    const double x = std::max(samples.motion[i].penetration, knots.front());
    const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
    const Eigen::Index left = above - knots.begin() - 1;
    const double share = (x - *(above - 1)) / (*above - *(above - 1));
    const Eigen::Vector2d weights(1.0 - share, share);
    equations.normal.block<2, 2>(left, left) += weights * weights.transpose();
    equations.right.segment<2>(left) += weights * samples.force[i];
  }
  return equations;
}

std::vector<double> forces_at_knots(const Samples& samples, const Mask& mask,
                                    const std::vector<double>& knots, const BranchOf& branch) {
  const HatEquations equations = hat_equations(samples, mask, knots, branch);
  const Eigen::VectorXd forces = solve_normal(equations.normal, equations.right);
  return {forces.begin(), forces.end()};
}

}  // namespace kerf::fitting
