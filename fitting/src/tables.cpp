#include "tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "segmented/segmented_law.h"

namespace kerf::fitting {
namespace {

constexpr double bridge = 1e-7;  ///< weight of the smoothness that carries a table over cells without data
constexpr Eigen::Index stretches = 20;
constexpr double fewest_groups = 1.5;
constexpr int max_reweighings = 50;
constexpr double settled = 1e-9;

/// Where a sample falls in a table: the point to its left, and its share of the next one.
struct Place {
  Eigen::Index left;
  double share;
};

/// The uniform grid of a table, looked up as the law does: held before the first point, and the last trend
/// goes on past the last one.
struct Grid {
  double first, last;
  Eigen::Index points;

  explicit Grid(const Problem& problem)
      : first(std::get<double>(problem.law_options.at("first"))),
        last(std::get<double>(problem.law_options.at("last"))),
        points(static_cast<Eigen::Index>(std::get<double>(problem.law_options.at("points")))) {}
  [[nodiscard]] Place operator()(double x) const {
    const double place = std::max(0.0, (x - first) * (static_cast<double>(points - 1) / (last - first)));
    const auto left = std::min(static_cast<Eigen::Index>(place), points - 2);
    return {.left = left, .share = place - static_cast<double>(left)};
  }
};

/// Normal equations of one branch: hats touch their neighbours only, so two diagonals hold all of them.
struct Equations {
  Eigen::VectorXd diagonal, beside, right;

  explicit Equations(Eigen::Index points)
      : diagonal(Eigen::VectorXd::Zero(points)), beside(diagonal), right(diagonal) {}
  void add(const Place& at, double force, double weight) {
    const double mine = 1.0 - at.share;
    diagonal[at.left] += weight * mine * mine;
    diagonal[at.left + 1] += weight * at.share * at.share;
    beside[at.left] += weight * mine * at.share;
    right[at.left] += weight * mine * force;
    right[at.left + 1] += weight * at.share * force;
  }
  /// With the second differences of the table, squared and summed: zero for any straight line.
  [[nodiscard]] Eigen::LLT<Eigen::MatrixXd> factor() const {
    const Eigen::Index points = diagonal.size();
    const double weight = bridge * std::max(1.0, diagonal.sum() / static_cast<double>(points));
    Eigen::MatrixXd matrix = diagonal.asDiagonal();
    for (Eigen::Index i = 0; i + 1 < points; ++i) matrix(i, i + 1) = matrix(i + 1, i) = beside[i];
    const Eigen::Vector3d difference(1.0, -2.0, 1.0);
    for (Eigen::Index i = 1; i + 1 < points; ++i) {
      matrix.block<3, 3>(i - 1, i - 1) += weight * difference * difference.transpose();
    }
    return matrix.llt();
  }
};

Equations equations_of(const Samples& samples, const Weights& weights, const Grid& grid,
                       const std::vector<std::uint8_t>& branch, int which) {
  Equations equations(grid.points);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (weights[i] > 0.0 && branch[i] == which)
      equations.add(grid(samples.motion[i].penetration), samples.force[i], weights[i]);
  }
  return equations;
}

/// What each sample weighs under a loss, where the table gives these forces.
Weights reweighed(const Weights& weights, const Samples& samples, const std::vector<double>& force,
                  const RobustLoss& loss) {
  Weights robust(weights);
  for (std::size_t i = 0; loss.kind != Loss::squares && i < force.size(); ++i) {
    const double residual = force[i] - samples.force[i];
    robust[i] *= loss(weights[i] * residual * residual).slope;
  }
  return robust;
}

/// Free air does not count; but where no row lies that does, a table is what the rows there say, and not
/// what a straight line comes to. Those deeper than the first that counts say nothing: the tool may have been
/// closed with nothing in it. Nor do those of a part that is held out.
Weights with_rows_before_those(const Samples& samples, const Weights& weights) {
  constexpr double faint = 1e-4;
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.counts[i] != 0) first = std::min(first, samples.motion[i].penetration);
  }
  std::vector<bool> is_shown(samples.folds, false);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (weights[i] > 0.0 && samples.fold[i] < samples.folds) is_shown[samples.fold[i]] = true;
  }
  Weights all(weights);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint32_t fold = samples.fold[i];
    const bool may_be_seen = fold < samples.folds ? is_shown[fold] : fold != Samples::test;
    const bool is_before = samples.counts[i] == 0 && samples.motion[i].penetration < first;
    if (is_before && may_be_seen) all[i] = faint;
  }
  return all;
}

bool loop_of(const Problem& problem) { return std::get<bool>(problem.law_options.at("loop")); }

}  // namespace

Solution solve_tables(const Problem& problem, const Samples& samples, const Weights& of_those_that_count,
                      const RobustLoss& loss) {
  const Grid grid(problem);
  const bool loop = loop_of(problem);
  const auto branch = branches(samples, loop);
  const Weights weights = with_rows_before_those(samples, of_those_that_count);
  Weights robust(weights);
  Solution solution{.values = {}, .converged = true, .iterations = 0, .message = "linear least squares"};
  for (int round = 0; round < max_reweighings; ++round) {
    ++solution.iterations;
    std::vector<double> values;
    for (int which = 0; which < (loop ? 2 : 1); ++which) {
      const Equations equations = equations_of(samples, robust, grid, branch, which);
      const auto factor = equations.factor();
      if (factor.info() != Eigen::Success || !(equations.diagonal.sum() > 0.0)) {
        return {.values = {},
                .converged = false,
                .iterations = 1,
                .message = "too few samples on a branch for a table"};
      }
      const Eigen::VectorXd forces = factor.solve(equations.right);
      values.insert(values.end(), forces.begin(), forces.end());
    }
    const Values last = std::exchange(solution.values, Values(problem.runs, values));
    if (loss.kind == Loss::squares) break;
    double moved = last.empty() ? 1.0 : 0.0;
    for (std::size_t i = 0; !last.empty() && i < values.size(); ++i)
      moved = std::max(moved, std::abs(values[i] - last[0][i]));
    if (moved < settled) break;
    robust = reweighed(weights, samples, rendered(problem, solution.values, samples), loss);
  }
  return solution;
}

std::vector<TableError> table_errors(const Problem& problem, const Samples& samples, const Weights& given,
                                     const std::vector<double>& values, const RobustLoss& loss) {
  const Grid grid(problem);
  const bool loop = loop_of(problem);
  const auto branch = branches(samples, loop);
  const auto force = rendered(problem, Values(problem.runs, values), samples);
  const Weights weights = reweighed(given, samples, force, loss);
  std::vector<TableError> errors;
  for (int which = 0; which < (loop ? 2 : 1); ++which) {
    const Equations equations = equations_of(samples, weights, grid, branch, which);
    Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(grid.points, stretches);
    Eigen::MatrixXd shares = scores;  // of the weight at a point, by stretch
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!(weights[i] > 0.0) || branch[i] != which) continue;
      const auto stretch =
          static_cast<Eigen::Index>(i * static_cast<std::size_t>(stretches) / samples.size());
      const Place at = grid(samples.motion[i].penetration);
      const double residual = weights[i] * (force[i] - samples.force[i]);
      scores(at.left, stretch) += (1.0 - at.share) * residual;
      scores(at.left + 1, stretch) += at.share * residual;
      shares(at.left, stretch) += weights[i] * (1.0 - at.share);
      shares(at.left + 1, stretch) += weights[i] * at.share;
    }
    const Eigen::VectorXd variance = equations.factor().solve(scores).rowwise().squaredNorm();
    for (Eigen::Index i = 0; i < grid.points; ++i) {
      const double sum = shares.row(i).sum();
      const double groups =
          sum > 0.0 ? sum * sum / shares.row(i).squaredNorm() : 0.0;  // as many of equal share
      const bool known = groups > fewest_groups;
      errors.push_back({.std_error = known ? std::sqrt(variance[i] * groups / (groups - 1.0))
                                           : std::numeric_limits<double>::infinity(),
                        .degrees_of_freedom = std::max(1.0, groups - 1.0)});
    }
  }
  return errors;
}

}  // namespace kerf::fitting
