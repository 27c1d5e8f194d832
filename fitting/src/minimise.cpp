#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "least_squares.h"
#include "minimise_over_kinks.h"

namespace kerf::fitting {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// p + 1 residuals with the sums of an objective: the triangle of J and Q'r, and what is left of r, which
/// does not change.
class Compressed final : public ceres::CostFunction {
 public:
  explicit Compressed(const Objective& objective) : objective_(objective) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(objective.size()));
    set_num_residuals(static_cast<int>(objective.size()) + 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index p = objective_.size();
    const Eigen::Map<const Eigen::VectorXd> at(parameters[0], p);
    if (!known_ || at_ != at) {  // the derivatives of a step that was taken are asked for a second time
      known_ = objective_.factor(at, sums_, triangle_);
      if (!known_ || !std::isfinite(sums_.squares) || !sums_.normal.allFinite()) return known_ = false;
      at_ = at;
    }
    Eigen::Map<Eigen::VectorXd>(residuals, p) = triangle_.z;
    residuals[p] = triangle_.rest;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor> jacobian(jacobians[0], p + 1, p);
      jacobian.topRows(p) = triangle_.r;
      jacobian.row(p).setZero();
    }
    return true;
  }

  [[nodiscard]] const Sums& sums_at(const Eigen::VectorXd& at) const {
    if (!known_ || at_ != at) {
      if (!objective_.evaluate(at, sums_)) sums_.normal.setZero(at.size(), at.size());
    }
    return sums_;
  }

 private:
  const Objective& objective_;
  mutable bool known_ = false;
  mutable Eigen::VectorXd at_;
  mutable Sums sums_;
  mutable Triangle triangle_;
};

/// Ceres reports a refused trial step as a warning of its log; a refused step is ordinary here.
void silence_log() {
  static const bool once = [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    return true;
  }();
  (void)once;
}

/// The trust region of Ceres, from minimum.at.
void search(Minimum& minimum, const Objective& objective, const Bounds& bounds,
            const MinimiseOptions& options) {
  auto owned = std::make_unique<Compressed>(objective);
  const Compressed& cost = *owned;
  ceres::Problem problem;
  problem.AddResidualBlock(owned.release(), nullptr, minimum.at.data());
  for (Eigen::Index k = 0; k < minimum.at.size(); ++k) {
    if (std::isfinite(bounds.lower[k]))
      problem.SetParameterLowerBound(minimum.at.data(), static_cast<int>(k), bounds.lower[k]);
    if (std::isfinite(bounds.upper[k]))
      problem.SetParameterUpperBound(minimum.at.data(), static_cast<int>(k), bounds.upper[k]);
  }
  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.max_num_iterations = options.iterations;
  settings.function_tolerance = options.function_tolerance;
  settings.gradient_tolerance = 1e-14;
  settings.parameter_tolerance = 1e-12;
  settings.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &problem, &summary);
  minimum.sums = cost.sums_at(minimum.at);
  minimum.converged = summary.termination_type == ceres::CONVERGENCE;
  minimum.iterations += static_cast<int>(summary.iterations.size());
  minimum.message = summary.message;
}

/// The coordinates that no bound holds against the way down.
std::vector<Eigen::Index> moving_within(const Bounds& bounds, const Eigen::VectorXd& at, const Sums& sums) {
  std::vector<Eigen::Index> moving;
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const bool below = at[k] <= bounds.lower[k] && sums.score[k] > 0.0;
    const bool above = at[k] >= bounds.upper[k] && sums.score[k] < 0.0;
    if (!below && !above) moving.push_back(k);
  }
  return moving;
}

/// A step of Gauss and Newton that leaves alone what a bound holds.
Eigen::VectorXd step_within(const Bounds& bounds, const Eigen::VectorXd& at, const Sums& sums,
                            const Triangle& triangle) {
  const auto moving = moving_within(bounds, at, sums);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(at.size());
  if (!moving.empty()) step(moving) = shortest_least_squares(triangle.r(Eigen::all, moving), -triangle.z);
  return step;
}

/// What J'J lacks of half the second derivative of a sum of squares, sum_i r_i d2r_i/dx2, as the scores along
/// the way show it (symmetric rank-one updates [DennisGayWelsch1981]). Where a law misfits it is large, and
/// steps of Gauss and Newton alone come nearer by no more than a share of the way each.
class Curvature {
 public:
  explicit Curvature(Eigen::Index size) : missing_(Eigen::MatrixXd::Zero(size, size)) {}

  void learn(const Eigen::VectorXd& step, const Sums& before, const Sums& after) {
    const Eigen::VectorXd unknown = after.score - before.score - after.normal * step - missing_ * step;
    const double along = unknown.dot(step);
    if (std::abs(along) <= 1e-8 * unknown.norm() * step.norm()) return;
    missing_ += unknown * unknown.transpose() / along;
    known_ = true;
  }

  /// A step of Newton; none where the whole second derivative is not positive, or nothing was learned.
  [[nodiscard]] std::optional<Eigen::VectorXd> step_within(const Bounds& bounds, const Eigen::VectorXd& at,
                                                           const Sums& sums) const {
    const auto moving = moving_within(bounds, at, sums);
    if (!known_ || moving.empty()) return std::nullopt;
    const Eigen::VectorXd scale = sums.normal.diagonal()(moving).cwiseSqrt().cwiseInverse();
    if (!scale.allFinite()) return std::nullopt;
    const Eigen::MatrixXd whole = sums.normal(moving, moving) + missing_(moving, moving);
    const auto step = solve_positive(scale.asDiagonal() * whole * scale.asDiagonal(),
                                     -scale.cwiseProduct(sums.score(moving)));
    if (!step) return std::nullopt;
    Eigen::VectorXd all = Eigen::VectorXd::Zero(at.size());
    all(moving) = scale.cwiseProduct(*step);
    return all;
  }

 private:
  Eigen::MatrixXd missing_;
  bool known_ = false;
};

/// Steps of Gauss and Newton, then of Newton, from near the minimum, as long as they lead down; the last,
/// which promises next to nothing, is taken unseen. False, and nothing changed, where they do not go that
/// way.
bool finish(Minimum& minimum, const Objective& objective, const Bounds& bounds, double tolerance) {
  constexpr int max_steps = 30;
  constexpr double next_to_nothing = 1e-10;
  Minimum next(minimum);
  Curvature curvature(minimum.at.size());
  for (int step = 0; step < max_steps; ++step) {
    const auto newton = curvature.step_within(bounds, next.at, next.sums);
    const Eigen::VectorXd whole =
        newton ? *newton : step_within(bounds, next.at, next.sums, triangle_of(next.sums));
    const Eigen::VectorXd at = (next.at + whole).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
    const Eigen::VectorXd change = at - next.at;
    const double promise = -change.dot(next.sums.score);
    if (!std::isfinite(promise) || promise > 0.1 * next.sums.squares) return false;
    const bool within = at == next.at + whole;
    next.at = at;
    ++next.iterations;
    if (within && promise <= std::max(tolerance, next_to_nothing) * next.sums.squares) {
      next.sums.squares -= promise;
      next.converged = true;
      next.message = "the next step promises less than the tolerance";
      minimum = std::move(next);
      return true;
    }
    const Sums before(next.sums);
    if (!objective.evaluate(next.at, next.sums) || !(next.sums.squares <= before.squares)) return false;
    curvature.learn(change, before, next.sums);
  }
  return false;
}

/// Steps of Gauss and Newton from a minimum to its last digits. There the sum of squares is flat to rounding,
/// and it is the promise of the next step that says whether one was good.
void settle(Minimum& minimum, const Objective& objective, const Bounds& bounds, double tolerance) {
  constexpr int max_steps = 50;
  constexpr double level = 1e-9;  // a rise of the sum of squares that may be rounding
  Triangle triangle;
  Sums sums;
  if (!objective.factor(minimum.at, sums, triangle)) return;
  double promised = std::numeric_limits<double>::infinity();
  for (int i = 0; i < max_steps; ++i) {
    const Eigen::VectorXd step = step_within(bounds, minimum.at, sums, triangle);
    const double promise = (triangle.r * step).squaredNorm();
    if (!(promise < 0.8 * promised) || (step.array().abs() <= tolerance * minimum.at.array().abs()).all())
      return;
    const Eigen::VectorXd next = (minimum.at + step).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
    if (!objective.factor(next, sums, triangle) || !(sums.squares <= (1.0 + level) * minimum.sums.squares))
      return;
    minimum.at = next;
    minimum.sums = sums;
    ++minimum.iterations;
    promised = promise;
  }
}

/// Tolerances above this ask for the error at a minimum, not for the minimum.
constexpr double to_the_last_digits = 1e-11;

/// Near the minimum a few plain steps do; they are tried before the trust region and after its first descent.
void descend(Minimum& minimum, const Objective& objective, const Bounds& bounds,
             const MinimiseOptions& options) {
  const auto finished = [&] { return finish(minimum, objective, bounds, options.function_tolerance); };
  if (objective.evaluate(minimum.at, minimum.sums) && finished()) return;
  MinimiseOptions coarse(options);
  coarse.function_tolerance = std::max(options.function_tolerance, 1e-2);
  search(minimum, objective, bounds, coarse);
  if (minimum.converged && finished()) return;
  search(minimum, objective, bounds, options);
  if (!minimum.converged || options.function_tolerance > to_the_last_digits) return;
  Minimum beyond = step_over_kinks(minimum, objective, bounds);
  if (!(beyond.sums.squares < (1.0 - to_the_last_digits) * minimum.sums.squares)) return;
  search(beyond, objective, bounds, options);
  if (beyond.sums.squares < minimum.sums.squares) minimum = std::move(beyond);
}

}  // namespace

Minimum minimise(const Objective& objective, const Eigen::VectorXd& start, const Bounds& bounds,
                 const MinimiseOptions& options) {
  silence_log();
  Minimum minimum{.at = start.cwiseMax(bounds.lower).cwiseMin(bounds.upper)};
  if (options.parameter_tolerance > 0.0) {
    search(minimum, objective, bounds, options);
    if (minimum.converged) settle(minimum, objective, bounds, options.parameter_tolerance);
  } else {
    descend(minimum, objective, bounds, options);
  }
  return minimum;
}

}  // namespace kerf::fitting
