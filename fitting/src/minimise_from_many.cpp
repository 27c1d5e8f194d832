#include <algorithm>
#include <utility>
#include <vector>

#include "least_squares.h"

namespace kerf::fitting {
namespace {

constexpr std::size_t followed = 3;  ///< copies, to their end

void keep_least(std::vector<std::pair<double, Eigen::VectorXd>>& points, std::size_t most) {
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (points.size() > most) points.resize(most);
}

std::vector<Eigen::VectorXd> copies_of(const Eigen::VectorXd& start) {
  std::vector<Eigen::VectorXd> copies;
  for (const double factor : {0.1, 10.0, 0.01, 100.0}) {
    copies.push_back(factor * start);
    for (Eigen::Index k = 0; k < start.size() && start.size() > 1; ++k) {
      copies.push_back(start);
      copies.back()[k] *= factor;
    }
  }
  return copies;
}

}  // namespace

Minimum minimise_from_many(const Objective& objective, const Eigen::VectorXd& start, const Bounds& bounds,
                           const MinimiseOptions& options, std::size_t most) {
  std::vector<std::pair<double, Eigen::VectorXd>> copies;
  for (const Eigen::VectorXd& copy : copies_of(start)) {
    Eigen::VectorXd inside = copy.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
    Sums sums;
    if (objective.evaluate(inside, sums)) copies.emplace_back(sums.squares, std::move(inside));
  }
  keep_least(copies, most);
  Minimum best = minimise(objective, start, bounds, options);
  int iterations = best.iterations;
  const MinimiseOptions brief{.iterations = std::max(50, options.iterations / 10),
                              .function_tolerance = 1e-6};
  for (auto& [squares, at] : copies) {
    const Minimum minimum = minimise(objective, at, bounds, brief);
    iterations += minimum.iterations;
    squares = minimum.sums.squares;
    at = minimum.at;
  }
  keep_least(copies, followed);
  for (const auto& [squares, at] : copies) {
    Minimum minimum = minimise(objective, at, bounds, options);
    iterations += minimum.iterations;
    if (minimum.converged && (!best.converged || minimum.sums.squares < best.sums.squares))
      best = std::move(minimum);
  }
  best.iterations = iterations;
  return best;
}

}  // namespace kerf::fitting
