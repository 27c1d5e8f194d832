#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <kerf/psychophysics/mixed_fit.h>

#include "checks.h"
#include "psychometric/shape.h"

namespace kerf::psychophysics {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr std::array mixed_lapses{0.0, 0.02, 0.04, 0.06};
constexpr double rarest = 1e-12;  ///< so that one lapse of somebody who never lapses has a logarithm
constexpr double steepest_log_slope = 12.0;  ///< a step, on an axis of unit span

/// Of Hermite's polynomials of exp(-x^2): 7 points, exact up to degree 13. [AbramowitzStegun1964], 25.10.
constexpr std::array<double, 7> hermite_at{-2.651961356835233, -1.673551628767471, -0.816287882858965, 0.0,
                                           0.816287882858965,  1.673551628767471,  2.651961356835233};
constexpr std::array<double, 7> hermite_weight{0.0009717812450995, 0.0545155828191270, 0.4256072526101278,
                                               0.8102646175568073, 0.4256072526101278, 0.0545155828191270,
                                               0.0009717812450995};

/// One row of answers, on an axis whose levels span one.
struct Answered {
  double x = 0.0;
  double successes = 0.0;
  double failures = 0.0;
};

/// Of everybody: psi = floor + height F(z).
struct Ends {
  Shape shape = Shape::gaussian;
  double floor = 0.0;
  double height = 1.0;
  double quantile = 0.0;  ///< q
};

/// Log-likelihood of a subject's answers at a curve (a, b), its gradient and Fisher's information.
struct At {
  double value = 0.0;
  Vector2d gradient = Vector2d::Zero();
  Matrix2d information = Matrix2d::Zero();
};

At likelihood_at(const std::vector<Answered>& cells, const Ends& ends, const Vector2d& curve) {
  At at;
  const double slope = std::exp(std::min(curve[1], steepest_log_slope));
  for (const Answered& cell : cells) {
    const double reach = slope * (cell.x - curve[0]);
    const ShapeAt shape = shape_at(ends.shape, ends.quantile + reach);
    const double right = std::max(rarest, ends.floor + ends.height * shape.below);
    const double wrong = std::max(rarest, 1.0 - ends.floor - ends.height * shape.below);
    at.value += (cell.successes > 0.0 ? cell.successes * std::log(right) : 0.0) +
                (cell.failures > 0.0 ? cell.failures * std::log(wrong) : 0.0);
    const double per_z = ends.height * shape.density;
    const Vector2d z_by_curve(-slope, curve[1] < steepest_log_slope ? reach : 0.0);
    at.gradient += (cell.successes / right - cell.failures / wrong) * per_z * z_by_curve;
    at.information += (cell.successes + cell.failures) / (right * wrong) * per_z * per_z * z_by_curve *
                      z_by_curve.transpose();
  }
  return at;
}

/// What the optimiser moves: mean curve and the Cholesky factor of S; the last two are held at 0 where slopes
/// are alike.
using Parameters = std::array<double, 5>;

struct Population {
  Vector2d mean;
  Matrix2d factor;
};

Population population_of(const double* parameters, bool slopes_differ) {
  Population population;
  population.mean << parameters[0], parameters[1];
  population.factor << parameters[2], 0.0, slopes_differ ? parameters[3] : 0.0,
      slopes_differ ? parameters[4] : 0.0;
  return population;
}

/// ln of the integral of one subject, and its gradient by Fisher's identity: the mean, over the curves that
/// the subject may have, of the gradient given the curve.
class SubjectIntegral {
 public:
  SubjectIntegral(const std::vector<Answered>& cells, const Ends& ends, const Population& population)
      : cells_(cells), ends_(ends), population_(population) {}

  double add_to(double* gradient) const {
    const auto [mode, root] = mode_and_root();
    std::array<double, 49> logs{};
    std::array<Vector2d, 49> deviates{};
    std::array<Vector2d, 49> slopes{};
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 49; ++i) {
      const Vector2d node(hermite_at[i / 7], hermite_at[i % 7]);
      const Vector2d u = mode + std::sqrt(2.0) * (root * node);
      const At at = likelihood_at(cells_, ends_, population_.mean + population_.factor * u);
      logs[i] = at.value - 0.5 * u.squaredNorm() + node.squaredNorm() + std::log(hermite_weight[i / 7]) +
                std::log(hermite_weight[i % 7]);
      deviates[i] = u;
      slopes[i] = at.gradient;
      largest = std::max(largest, logs[i]);
    }
    double sum = 0.0;
    for (const double each : logs) sum += std::exp(each - largest);
    const double log_integral = largest + std::log(sum);
    for (std::size_t i = 0; i < 49 && gradient != nullptr; ++i) {
      const double weight = std::exp(logs[i] - log_integral);
      gradient[0] += weight * slopes[i][0];
      gradient[1] += weight * slopes[i][1];
      gradient[2] += weight * slopes[i][0] * deviates[i][0];
      gradient[3] += weight * slopes[i][1] * deviates[i][0];
      gradient[4] += weight * slopes[i][1] * deviates[i][1];
    }
    // du = 2 |root| dnode, over the normal's 2 pi.
    return log_integral + std::log(root.determinant()) - std::log(3.14159265358979323846);
  }

 private:
  struct Mode {
    Vector2d at;
    Matrix2d root;  ///< of the inverse of the information there: what the integrand is wide
  };

  [[nodiscard]] At penalised(const Vector2d& u) const {
    At at = likelihood_at(cells_, ends_, population_.mean + population_.factor * u);
    at.value -= 0.5 * u.squaredNorm();
    at.gradient = population_.factor.transpose() * at.gradient - u;
    at.information =
        population_.factor.transpose() * at.information * population_.factor + Matrix2d::Identity();
    return at;
  }

  [[nodiscard]] Mode mode_and_root() const {
    Vector2d u = Vector2d::Zero();
    At at = penalised(u);
    for (int round = 0; round < 60; ++round) {
      const Vector2d step = at.information.ldlt().solve(at.gradient);
      if (step.squaredNorm() < 1e-20) break;
      double part = 1.0;
      At there = penalised(u + step);
      while (!(there.value >= at.value) && part > 1e-6) {
        part *= 0.5;
        there = penalised(u + part * step);
      }
      if (part <= 1e-6) break;
      u += part * step;
      at = there;
    }
    return {.at = u, .root = Matrix2d(at.information.inverse()).llt().matrixL()};
  }

  const std::vector<Answered>& cells_;
  const Ends& ends_;
  const Population& population_;
};

/// Less the log-likelihood of all.
class MixedLikelihood final : public ceres::FirstOrderFunction {
 public:
  MixedLikelihood(const std::vector<std::vector<Answered>>& subjects, const Ends& ends, bool slopes_differ)
      : subjects_(subjects), ends_(ends), slopes_differ_(slopes_differ) {}

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const Population population = population_of(parameters, slopes_differ_);
    double sum = 0.0;
    Parameters by{};
    for (const auto& cells : subjects_)
      sum += SubjectIntegral(cells, ends_, population).add_to(gradient == nullptr ? nullptr : by.data());
    if (!std::isfinite(sum)) return false;
    *cost = -sum;
    if (gradient == nullptr) return true;
    for (std::size_t i = 0; i < by.size(); ++i) gradient[i] = i < 3 || slopes_differ_ ? -by[i] : 0.0;
    return true;
  }
  int NumParameters() const override { return 5; }

 private:
  const std::vector<std::vector<Answered>>& subjects_;
  Ends ends_;
  bool slopes_differ_;
};

struct MixedMaximum {
  Parameters at{};
  double log_likelihood = -std::numeric_limits<double>::infinity();
};

/// With one lapse rate.
struct CurveWithLapse {
  MixedMaximum found;
  double lapse = 0.0;
  bool says_a_curve = false;
  Matrix2d covariance = Matrix2d::Zero();  ///< of the mean curve
};

/// From a start; nothing where the likelihood is no number there.
MixedMaximum found_from(const MixedLikelihood& marginal, Parameters at,
                        const ceres::GradientProblem& problem) {
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::BFGS;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-11;
  options.gradient_tolerance = 1e-7;
  options.parameter_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, at.data(), &summary);
  MixedMaximum found{.at = at};
  double cost = 0.0;
  if (marginal.Evaluate(at.data(), &cost, nullptr)) found.log_likelihood = -cost;
  return found;
}

/// The levels on an axis of unit span, and back.
struct MixedAxis {
  Axis axis = Axis::linear;
  double origin = 0.0;
  double span = 1.0;
  [[nodiscard]] double inside(double intensity) const {
    return ((axis == Axis::logarithmic ? std::log(intensity) : intensity) - origin) / span;
  }
  [[nodiscard]] double outside(double x) const {
    const double value = origin + span * x;
    return axis == Axis::logarithmic ? std::exp(value) : value;
  }
};

MixedAxis axis_of_unit_span(std::span<const std::vector<Level>> subjects, Axis axis) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const std::vector<Level>& levels : subjects) {
    for (const Level& level : levels) {
      require(std::isfinite(level.intensity) && (axis == Axis::linear || level.intensity > 0.0),
              "a level of a logarithmic axis must be above 0");
      const double x = axis == Axis::logarithmic ? std::log(level.intensity) : level.intensity;
      least = std::min(least, x);
      most = std::max(most, x);
    }
  }
  require(most > least, "all answers are at one level: a curve needs two at least");
  return {.axis = axis, .origin = 0.5 * (least + most), .span = most - least};
}

std::vector<std::vector<Answered>> answered_by(std::span<const std::vector<Level>> subjects,
                                               const MixedAxis& axis) {
  std::vector<std::vector<Answered>> all;
  Count count;
  for (const std::vector<Level>& levels : subjects) {
    std::vector<Answered>& cells = all.emplace_back();
    for (const Level& level : levels) {
      require(level.answers);
      if (level.answers.trials == 0) continue;
      cells.push_back({.x = axis.inside(level.intensity),
                       .successes = static_cast<double>(level.answers.successes),
                       .failures = static_cast<double>(level.answers.trials - level.answers.successes)});
      count.trials += level.answers.trials;
      count.successes += level.answers.successes;
    }
    require(!cells.empty(), "a subject gave no answers");
  }
  require(count.successes > 0 && count.successes < count.trials,
          "all answers are alike: a curve needs both kinds");
  return all;
}

Ends ends_of(const MixedOptions& options, double lapse) {
  Ends ends{.shape = options.shape,
            .floor = options.two_sided ? lapse : options.guess,
            .height = options.two_sided ? 1.0 - 2.0 * lapse : 1.0 - options.guess - lapse};
  const double criterion =
      options.criterion.value_or(options.two_sided ? 0.5 : options.guess + 0.5 * (1.0 - options.guess));
  const double share = (criterion - ends.floor) / ends.height;
  require_probability(share, "the criterion, freed of guesses and lapses,");
  ends.quantile = shape_quantile(options.shape, share);
  return ends;
}

/// The information about the mean curve, S as it is: central differences of the gradient.
Matrix2d mean_information(const MixedLikelihood& marginal, const Parameters& at) {
  constexpr double step = 1e-4;
  Matrix2d information;
  for (int i = 0; i < 2; ++i) {
    std::array<Parameters, 2> gradients{};
    for (int side = 0; side < 2; ++side) {
      Parameters moved = at;
      moved[static_cast<std::size_t>(i)] += side == 0 ? -step : step;
      double cost = 0.0;
      marginal.Evaluate(moved.data(), &cost, gradients[static_cast<std::size_t>(side)].data());
    }
    for (int j = 0; j < 2; ++j) {
      const auto at_j = static_cast<std::size_t>(j);
      information(i, j) = (gradients[1][at_j] - gradients[0][at_j]) / (2.0 * step);
    }
  }
  return 0.5 * (information + information.transpose());
}

/// Of some starts, one of them what the last lapse rate came to.
MixedMaximum best_of_starts(const MixedLikelihood& marginal, const MixedMaximum& last) {
  // The problem takes the function, which another one forwards to.
  class Lent final : public ceres::FirstOrderFunction {
   public:
    explicit Lent(const MixedLikelihood& of) : of_(of) {}
    bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
      return of_.Evaluate(parameters, cost, gradient);
    }
    int NumParameters() const override { return of_.NumParameters(); }

   private:
    const MixedLikelihood& of_;
  };
  const ceres::GradientProblem problem(new Lent(marginal));
  if (std::isfinite(last.log_likelihood)) return found_from(marginal, last.at, problem);
  MixedMaximum best;
  for (const double log_slope : {0.5, 2.0}) {
    const MixedMaximum found = found_from(marginal, {0.0, log_slope, 0.2, 0.0, 0.2}, problem);
    if (found.log_likelihood > best.log_likelihood) best = found;
  }
  return best;
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
  require(options.guess >= 0.0 && options.guess < 1.0, "guesses are right in a share of 0 to 1");
  require(!options.lapse || (*options.lapse >= 0.0 && *options.lapse < 0.25),
          "a lapse rate lies in 0 to 0.25");
  const MixedAxis axis = axis_of_unit_span(subjects, options.axis);
  const std::vector<std::vector<Answered>> cells = answered_by(subjects, axis);
  std::vector<double> lapses(mixed_lapses.begin(), mixed_lapses.end());
  if (options.lapse) lapses = {*options.lapse};

  std::vector<CurveWithLapse> curves;
  for (const double lapse : lapses) {
    const MixedLikelihood marginal(cells, ends_of(options, lapse), options.slopes_differ);
    CurveWithLapse curve{
        .found = best_of_starts(marginal, curves.empty() ? MixedMaximum() : curves.back().found),
        .lapse = lapse};
    if (!std::isfinite(curve.found.log_likelihood)) continue;
    const Eigen::LLT<Matrix2d> information(mean_information(marginal, curve.found.at));
    curve.says_a_curve = information.info() == Eigen::Success;
    if (curve.says_a_curve) curve.covariance = information.solve(Matrix2d::Identity());
    curves.push_back(curve);
  }
  require(!curves.empty(), "no curve of people has a likelihood of these answers");
  const CurveWithLapse& best =
      *std::max_element(curves.begin(), curves.end(), [](const CurveWithLapse& a, const CurveWithLapse& b) {
        return a.found.log_likelihood < b.found.log_likelihood;
      });
  require(best.says_a_curve, "the answers do not say a curve of people: they fit a step or a flat line");

  const auto n = static_cast<double>(subjects.size());
  const Population population = population_of(best.found.at.data(), options.slopes_differ);
  const Matrix2d between = population.factor * population.factor.transpose();
  MixedFit fit;
  fit.threshold = {.mean = axis.outside(best.found.at[0]),
                   .is_ratio = options.axis == Axis::logarithmic,
                   .deviation = axis.span * std::sqrt(between(0, 0)),
                   .degrees_of_freedom = n - 1.0,
                   .with_lapses = {}};
  fit.slope = {.mean = std::exp(best.found.at[1]) / axis.span,
               .is_ratio = true,
               .deviation = std::sqrt(between(1, 1)),
               .degrees_of_freedom = n - 1.0,
               .with_lapses = {}};
  for (const CurveWithLapse& curve : curves) {
    if (!curve.says_a_curve) continue;
    const double loss = 2.0 * (best.found.log_likelihood - curve.found.log_likelihood);
    const auto error = [&](int i) { return std::sqrt(curve.covariance(i, i) * n / (n - 1.0)); };
    fit.threshold.with_lapses.push_back(
        {.mean = axis.outside(curve.found.at[0]), .standard_error = axis.span * error(0), .loss = loss});
    fit.slope.with_lapses.push_back(
        {.mean = std::exp(curve.found.at[1]) / axis.span, .standard_error = error(1), .loss = loss});
  }
  const double both = std::sqrt(between(0, 0) * between(1, 1));
  fit.correlation = both > 0.0 ? between(0, 1) / both : 0.0;
  fit.lapse = best.lapse;
  fit.log_likelihood = best.found.log_likelihood;
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
