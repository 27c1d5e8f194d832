#include "search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "segments.h"
#include "starts.h"

namespace kerf::fitting {
namespace {

constexpr double bridge = 1e-7;  ///< weight of the smoothness that carries a table over cells without data

std::vector<double> table_grid(const Problem& problem) {
  const double first = std::get<double>(problem.law_options.at("first"));
  const double last = std::get<double>(problem.law_options.at("last"));
  const auto points = static_cast<std::size_t>(std::get<double>(problem.law_options.at("points")));
  std::vector<double> grid;
  for (std::size_t i = 0; i < points; ++i) {
    grid.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(points - 1));
  }
  return grid;
}

/// Second differences of the table, squared and summed: zero for any straight line.
Eigen::MatrixXd roughness(Eigen::Index points) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(points, points);
  for (Eigen::Index i = 1; i + 1 < points; ++i) {
    const Eigen::Vector3d difference(1.0, -2.0, 1.0);
    matrix.block<3, 3>(i - 1, i - 1) += difference * difference.transpose();
  }
  return matrix;
}

/// What of a mask lies in one stretch of the samples.
Mask stretch_of(const Mask& mask, Eigen::Index stretch) {
  const auto size = static_cast<Eigen::Index>(mask.size());
  Mask part(mask.size(), false);
  for (Eigen::Index i = stretch * size / stretch_count; i < (stretch + 1) * size / stretch_count; ++i) {
    part[static_cast<std::size_t>(i)] = mask[static_cast<std::size_t>(i)];
  }
  return part;
}

/// The tables that interpolate the samples best, by linear least squares: no search is needed. The Jacobian
/// is given by its triangular factor, which has the same products.
Solution solve_tables(const Problem& problem, const Samples& samples, const Mask& mask) {
  const auto grid = table_grid(problem);
  const bool loop = std::get<bool>(problem.law_options.at("loop"));
  const auto points = static_cast<Eigen::Index>(grid.size());
  const Eigen::Index branches = loop ? 2 : 1;
  Solution solution;
  solution.normal.setZero(points * branches, points * branches);
  solution.stretches.assign(stretch_count,
                            {.normal = Eigen::MatrixXd::Zero(points * branches, points * branches),
                             .score = Eigen::VectorXd::Zero(points * branches)});
  solution.converged = true;
  solution.iterations = 1;
  solution.message = "linear least squares";
  for (Eigen::Index branch = 0; branch < branches; ++branch) {
    const BranchOf mine{.loop = loop, .closing = branch == 0};
    HatEquations equations = hat_equations(samples, mask, grid, mine);
    equations.normal +=
        bridge * std::max(1.0, equations.normal.trace() / static_cast<double>(points)) * roughness(points);
    const Eigen::LLT<Eigen::MatrixXd> factor(equations.normal);
    if (factor.info() != Eigen::Success) {
      solution.converged = false;
      solution.message = "too few samples on a branch for a table";
      solution.values.insert(solution.values.end(), grid.size(), 0.0);
      continue;
    }
    const Eigen::VectorXd forces = factor.solve(equations.right);
    solution.values.insert(solution.values.end(), forces.begin(), forces.end());
    solution.normal.block(branch * points, branch * points, points, points) = equations.normal;
    for (Eigen::Index i = 0; i < stretch_count; ++i) {
      const HatEquations part = hat_equations(samples, stretch_of(mask, i), grid, mine);
      Stretch& stretch = solution.stretches[static_cast<std::size_t>(i)];
      stretch.normal.block(branch * points, branch * points, points, points) = part.normal;
      stretch.score.segment(branch * points, points) = part.normal * forces - part.right;
    }
  }
  return solution;
}

Solution best_of(const Problem& problem, const Samples& samples, const Mask& mask,
                 const std::vector<std::vector<double>>& starts) {
  Solution best;
  best.message = "no start could be made from the data";
  int iterations = 0;
  for (const auto& start : starts) {
    Solution solution = solve(problem, samples, mask, start);
    iterations += solution.iterations;
    const bool better =
        best.values.empty() || (solution.converged && !best.converged) ||
        (solution.converged == best.converged && solution.sum_of_squares < best.sum_of_squares);
    if (better) best = std::move(solution);
  }
  best.iterations = iterations;
  return best;
}

}  // namespace

Problem make_problem(std::string_view model, const models::Options& given, const Samples& samples) {
  check_model(model);
  Problem problem{.model = model, .law_options = given, .parameters = {}, .free = {}};
  models::Options& options = problem.law_options;
  if (model == "piecewise" || model == "recording") options.try_emplace("loop", samples.has_cycles);
  if (model == "recording") {
    options.try_emplace("points", 101.0);
    options.try_emplace("first", samples.least);
    options.try_emplace("last", samples.most);
  }
  problem.parameters = models::Law::parameters(model, options);
  problem.free.assign(problem.parameters.size(), true);
  if (model == "piecewise") {
    const auto is_knot = [](const auto& info) { return info.name.starts_with("knot"); };
    const auto knots = static_cast<std::size_t>(
        std::count_if(problem.parameters.begin(), problem.parameters.end(), is_knot));
    problem.free[0] = problem.free[knots - 1] = false;  // the ends of the data
  }
  return problem;
}

Solution search(const Problem& problem, const Samples& samples, const Mask& mask,
                const std::vector<double>& near) {
  if (problem.model == "recording") return solve_tables(problem, samples, mask);
  if (!near.empty()) return solve(problem, samples, mask, near);
  if (problem.model == "piecewise") {
    const auto start = segmented_start(problem, samples, mask);
    return best_of(
        problem, samples, mask,
        start.empty() ? std::vector<std::vector<double>>{} : std::vector<std::vector<double>>{start});
  }
  return best_of(problem, samples, mask, scan_starts(problem, samples, mask));
}

}  // namespace kerf::fitting
