#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <kerf/psychophysics/mixed_fit.h>

#include "checks.h"
#include "psychometric/psychometric_problem.h"
#include "psychometric/shape.h"
#include "psychometric/subject_integral.h"

namespace kerf::psychophysics {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr std::array mixed_lapses{0.0, 0.02, 0.04, 0.06};

/// Subjects with one lapse rate.
struct Subjects {
  std::vector<Problem> problems;
  double lapse = 0.0;
  bool slopes_differ = true;
};

Population population_of(const double* at, bool slopes_differ) {
  Population population;
  population.mean << at[0], at[1];
  population.factor << at[2], 0.0, slopes_differ ? at[3] : 0.0, slopes_differ ? at[4] : 0.0;
  return population;
}

/// Less the log-likelihood of all.
class MixedLikelihood final : public ceres::FirstOrderFunction {
 public:
  explicit MixedLikelihood(const Subjects& subjects) : subjects_(subjects) {}

  bool Evaluate(const double* at, double* cost, double* gradient) const override {
    const Population population = population_of(at, subjects_.slopes_differ);
    double sum = 0.0;
    Parameters by{};
    for (const Problem& problem : subjects_.problems)
      sum += log_integral(problem, subjects_.lapse, population, gradient == nullptr ? nullptr : &by);
    if (!std::isfinite(sum)) return false;
    *cost = -sum;
    if (gradient == nullptr) return true;
    for (std::size_t i = 0; i < by.size(); ++i) gradient[i] = i < 3 || subjects_.slopes_differ ? -by[i] : 0.0;
    return true;
  }
  int NumParameters() const override { return std::tuple_size_v<Parameters>; }

 private:
  const Subjects& subjects_;
};

/// The largest likelihood with one lapse rate.
struct MixedMaximum {
  Parameters at{};
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double lapse = 0.0;
  bool says_a_curve = false;
  Matrix2d covariance = Matrix2d::Zero();  ///< of the mean curve
};

/// From a start; no likelihood where it is no number there.
MixedMaximum maximum_from(const ceres::GradientProblem& problem, const Parameters& start) {
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::BFGS;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-11;
  options.gradient_tolerance = 1e-7;
  options.parameter_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  MixedMaximum found{.at = start};
  ceres::Solve(options, problem, found.at.data(), &summary);
  double cost = 0.0;
  if (problem.Evaluate(found.at.data(), &cost, nullptr)) found.log_likelihood = -cost;
  return found;
}

/// The information about the mean curve, S as it is: central differences of the gradient.
Matrix2d mean_information(const ceres::GradientProblem& problem, const Parameters& at) {
  constexpr double step = 1e-4;
  const auto gradient_at = [&](std::size_t i, double moved_by) {
    Parameters moved = at;
    moved[i] += moved_by;
    Parameters gradient{};
    double cost = 0.0;
    problem.Evaluate(moved.data(), &cost, gradient.data());
    return Vector2d(gradient[0], gradient[1]);
  };
  Matrix2d information;
  for (std::size_t i = 0; i < 2; ++i)
    information.col(static_cast<Eigen::Index>(i)) =
        (gradient_at(i, step) - gradient_at(i, -step)) / (2.0 * step);
  return 0.5 * (information + information.transpose());
}

/// From where another lapse rate led, or from some starts.
MixedMaximum maximum_of(const Subjects& subjects, const MixedMaximum* other) {
  const ceres::GradientProblem problem(new MixedLikelihood(subjects));
  MixedMaximum best;
  if (other != nullptr) {
    best = maximum_from(problem, other->at);
  } else {
    for (const double log_slope : {0.5, 2.0}) {
      const MixedMaximum found = maximum_from(problem, {0.5, log_slope, 0.2, 0.0, 0.2});
      if (found.log_likelihood > best.log_likelihood) best = found;
    }
  }
  best.lapse = subjects.lapse;
  if (!std::isfinite(best.log_likelihood)) return best;
  const Eigen::LLT<Matrix2d> information(mean_information(problem, best.at));
  best.says_a_curve = information.info() == Eigen::Success;
  if (best.says_a_curve) best.covariance = information.solve(Matrix2d::Identity());
  return best;
}

FitOptions options_of_one(const MixedOptions& options, double lapse) {
  FitOptions one{.shape = options.shape,
                 .axis = options.axis,
                 .guess = options.guess,
                 .lapse = lapse,
                 .criterion = options.criterion};
  if (!options.two_sided) return one;
  one.guess = lapse;
  one.criterion = options.criterion.value_or(0.5);
  return one;
}

/// On the axis of all levels together.
ScaledProblem scaled_together(std::span<const std::vector<Level>> subjects, const FitOptions& options) {
  std::vector<Level> all;
  for (const std::vector<Level>& levels : subjects) all.insert(all.end(), levels.begin(), levels.end());
  return scaled_problem(all, options);
}

std::vector<Problem> taken_apart(const Problem& together, std::span<const std::vector<Level>> subjects) {
  std::vector<Problem> problems;
  std::size_t next = 0;
  for (const std::vector<Level>& levels : subjects) {
    Problem& own = problems.emplace_back(together);
    own.cells.clear();
    for (const Level& level : levels) {
      if (level.answers.trials > 0) own.cells.push_back(together.cells[next++]);
    }
    require(!own.cells.empty(), "a subject gave no answers");
  }
  return problems;
}

void require_both_kinds(const Problem& together) {
  Count all;
  for (const Cell& cell : together.cells) {
    all.successes += cell.answers.successes;
    all.trials += cell.answers.trials;
  }
  require(all.successes > 0 && all.successes < all.trials, "all answers are alike: a curve needs both kinds");
}

}  // namespace

Interval OfPeople::interval(double confidence) const {
  require_probability(confidence, "the confidence");
  const double t = boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.5 + 0.5 * confidence);
  Interval whole{.lower = infinite, .upper = -infinite};
  for (const WithLapse& each : with_lapses) {
    if (each.loss >= t * t) continue;
    const double half = each.standard_error * std::sqrt(t * t - each.loss);
    whole.lower = std::min(whole.lower, is_ratio ? each.mean * std::exp(-half) : each.mean - half);
    whole.upper = std::max(whole.upper, is_ratio ? each.mean * std::exp(half) : each.mean + half);
  }
  return whole;
}

MixedFit fit_mixed(std::span<const std::vector<Level>> subjects, const MixedOptions& options) {
  require(subjects.size() >= 3, "people are spoken of from three subjects on");
  std::vector<double> lapses(mixed_lapses.begin(), mixed_lapses.end());
  if (options.lapse) lapses = {*options.lapse};

  ScaledAxis axis;
  std::vector<MixedMaximum> maxima;
  for (const double lapse : lapses) {
    const ScaledProblem together = scaled_together(subjects, options_of_one(options, lapse));
    require_both_kinds(together.problem);
    axis = together.axis;
    MixedMaximum found = maximum_of({.problems = taken_apart(together.problem, subjects),
                                     .lapse = lapse,
                                     .slopes_differ = options.slopes_differ},
                                    maxima.empty() ? nullptr : &maxima.back());
    if (std::isfinite(found.log_likelihood)) maxima.push_back(found);
  }
  require(!maxima.empty(), "no curve of people has a likelihood of these answers");
  const MixedMaximum& best = *std::max_element(
      maxima.begin(), maxima.end(),
      [](const MixedMaximum& a, const MixedMaximum& b) { return a.log_likelihood < b.log_likelihood; });
  require(best.says_a_curve, "the answers do not say a curve of people: they fit a step or a flat line");

  const auto n = static_cast<double>(subjects.size());
  const Population population = population_of(best.at.data(), options.slopes_differ);
  const Matrix2d between = population.factor * population.factor.transpose();
  const auto slope = [&](const MixedMaximum& maximum) { return std::exp(maximum.at[1]) / axis.span; };
  MixedFit fit;
  fit.threshold = {.mean = axis.intensity(best.at[0]),
                   .is_ratio = options.axis == Axis::logarithmic,
                   .deviation = axis.span * std::sqrt(between(0, 0)),
                   .degrees_of_freedom = n - 1.0,
                   .with_lapses = {}};
  fit.slope = {.mean = slope(best),
               .is_ratio = true,
               .deviation = std::sqrt(between(1, 1)),
               .degrees_of_freedom = n - 1.0,
               .with_lapses = {}};
  for (const MixedMaximum& each : maxima) {
    if (!each.says_a_curve) continue;
    const double loss = 2.0 * (best.log_likelihood - each.log_likelihood);
    const auto error = [&](int i) { return std::sqrt(each.covariance(i, i) * n / (n - 1.0)); };
    fit.threshold.with_lapses.push_back(
        {.mean = axis.intensity(each.at[0]), .standard_error = axis.span * error(0), .loss = loss});
    fit.slope.with_lapses.push_back({.mean = slope(each), .standard_error = error(1), .loss = loss});
  }
  const double both = std::sqrt(between(0, 0) * between(1, 1));
  fit.correlation = both > 0.0 ? between(0, 1) / both : 0.0;
  fit.lapse = best.lapse;
  fit.log_likelihood = best.log_likelihood;
  fit.subjects = subjects.size();
  return fit;
}

OfPeople half_interquartile(const MixedFit& fit, Shape shape) {
  const double reach = 0.5 * (shape_quantile(shape, 0.75) - shape_quantile(shape, 0.25));
  OfPeople jnd = fit.slope;
  jnd.mean = reach / fit.slope.mean;
  for (OfPeople::WithLapse& each : jnd.with_lapses) each.mean = reach / each.mean;
  return jnd;
}

}  // namespace kerf::psychophysics
