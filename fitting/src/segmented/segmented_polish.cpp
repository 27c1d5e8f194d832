#include "segmented/segmented_polish.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>

#include "segmented/segmented_grid.h"
#include "segmented/segmented_knots.h"
#include "segmented/segmented_line.h"

namespace kerf::fitting::segmented {
namespace {

constexpr double polish_gain = 1e-10;  ///< share of the error below which a gain is not worth another round
constexpr int rounds = 40;

std::vector<double> with_ends(const double* inner, std::size_t count) {
  std::vector<double> knots{0.0};
  knots.insert(knots.end(), inner, inner + count);
  knots.push_back(1.0);
  return knots;
}

/// The sum of squares as Ceres wants it: as few residuals as there are knots, and one for the rest, with the
/// same normal equations as those of all points.
class Knots : public ceres::CostFunction {
 public:
  Knots(const Points& points, std::size_t inner, std::size_t fewest_points)
      : points_(points), inner_(inner), fewest_points_(fewest_points) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(inner));
    set_num_residuals(static_cast<int>(inner) + 1);
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const auto knots = with_ends(parameters[0], inner_);
    if (!allowed(points_, knots, fewest_points_)) return false;
    Sensitivity sensitivity;
    const Forces forces = best_forces(points_, knots, &sensitivity);
    const Eigen::SelfAdjointEigenSolver<Sensitivity::Matrix> modes(sensitivity.normal);
    const auto count = static_cast<Eigen::Index>(inner_);
    const Sensitivity::Vector along = modes.eigenvectors().transpose() * sensitivity.gradient;
    double rest = forces.error;
    Sensitivity::Vector root(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double value = modes.eigenvalues()[i];
      root[i] = value > 1e-14 * modes.eigenvalues()[count - 1] ? std::sqrt(value) : 0.0;
      residuals[i] = root[i] > 0.0 ? along[i] / root[i] : 0.0;
      rest -= residuals[i] * residuals[i];
    }
    residuals[count] = std::sqrt(std::max(0.0, rest));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
          jacobians[0], count + 1, count);
      jacobian.topRows(count) = root.asDiagonal() * modes.eigenvectors().transpose();
      jacobian.bottomRows(1).setZero();
    }
    return true;
  }

 private:
  const Points& points_;
  std::size_t inner_, fewest_points_;
};

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 60;
  options.max_num_consecutive_invalid_steps = 40;
  options.function_tolerance = 1e-13;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-14;
  options.num_threads = 1;
  return options;
}

/// Around a knot: the nearest positions of points, and positions up to a cell away.
std::vector<double> neighbourhood(const Points& points, double knot, double cell, bool near) {
  std::vector<double> places{knot};
  if (near) {
    const auto at =
        std::lower_bound(points.places.begin(), points.places.end(), knot) - points.places.begin();
    for (const std::ptrdiff_t step : {0, 1, 2, 3, 5, 8, 13, 21, 40}) {
      for (const std::ptrdiff_t i : {at - step, at + step}) {
        if (i > 0 && i < std::ssize(points.places) - 1)
          places.push_back(points.places[static_cast<std::size_t>(i)]);
      }
    }
  } else {
    for (double step = cell; step > cell / 100.0; step *= 0.5) {
      places.push_back(knot - step);
      places.push_back(knot + step);
    }
  }
  return places;
}

/// The best knots with each from its neighbourhood, by dynamic programming.
Polished among_neighbours(const Points& points, const Polished& start, std::size_t fewest_points, double cell,
                          bool near, double bound) {
  Grid grid;
  grid.max_segments = start.knots.size() - 1;
  grid.fewest_points = fewest_points;
  grid.beam = 8;
  grid.reachable.assign(grid.max_segments + 1, std::min(start.error, bound));
  std::vector<std::vector<double>> around;
  grid.places = {0.0, 1.0};
  for (std::size_t i = 1; i + 1 < start.knots.size(); ++i) {
    auto places = neighbourhood(points, start.knots[i], cell, near);
    std::erase_if(places, [](double x) { return !(x > least_gap && x < 1.0 - least_gap); });
    std::sort(places.begin(), places.end());
    grid.places.insert(grid.places.end(), places.begin(), places.end());
    around.push_back(std::move(places));
  }
  std::sort(grid.places.begin(), grid.places.end());
  grid.places.erase(std::unique(grid.places.begin(), grid.places.end()), grid.places.end());
  const auto where = [&](double x) {
    return static_cast<std::size_t>(std::lower_bound(grid.places.begin(), grid.places.end(), x) -
                                    grid.places.begin());
  };
  for (const auto& places : around) grid.windows.emplace_back(where(places.front()), where(places.back()));
  const GridPath path = search_grid(points, grid).front();
  if (path.knots.empty()) return start;
  const double error = best_forces(points, path.knots).error;
  if (!(error < start.error)) return start;
  return {.knots = path.knots, .error = error, .converged = start.converged, .iterations = start.iterations};
}

}  // namespace

Polished descend(const Points& points, const std::vector<double>& knots, std::size_t fewest_points) {
  Polished best{.knots = knots, .error = best_forces(points, knots).error};
  const std::size_t inner = knots.size() - 2;
  if (inner == 0 || !allowed(points, knots, fewest_points)) return best;
  std::vector<double> values(knots.begin() + 1, knots.end() - 1);
  ceres::Problem problem;
  problem.AddResidualBlock(new Knots(points, inner, fewest_points), nullptr, values.data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  best.iterations = static_cast<int>(summary.iterations.size());
  best.converged = summary.termination_type == ceres::CONVERGENCE;
  const auto moved = with_ends(values.data(), inner);
  if (!allowed(points, moved, fewest_points)) return best;
  const double error = best_forces(points, moved).error;
  if (error < best.error) {
    best.knots = moved;
    best.error = error;
  }
  return best;
}

Polished settle(const Points& points, const Polished& start, std::size_t fewest_points, double cell,
                double bound) {
  Polished best = start;
  if (best.knots.size() <= 2) return best;
  int idle = 0;
  for (int round = 0; round < rounds && idle < 2; ++round) {
    const double before = best.error;
    Polished next = among_neighbours(points, best, fewest_points, cell, round % 2 == 0, bound);
    if (next.error < best.error) {
      Polished moved = descend(points, next.knots, fewest_points);
      moved.iterations += best.iterations;
      best = moved.error < next.error ? std::move(moved) : std::move(next);
    }
    idle = best.error < before - polish_gain * before ? 0 : idle + 1;
  }
  best.converged = best.converged || idle >= 2;
  return best;
}

}  // namespace kerf::fitting::segmented
