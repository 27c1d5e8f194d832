#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <kerf/psychophysics/psychometric_fit.h>

#include "checks.h"
#include "normal.h"
#include "psychometric/likelihood.h"
#include "psychometric/profile.h"
#include "psychometric/psychometric_problem.h"
#include "psychometric/shape.h"

namespace kerf::psychophysics {
namespace {

constexpr double max_dispersion = 9.0;  ///< rho = 0.9

/// Twice the loss of log-likelihood at the ends of an interval. A dispersion that is itself estimated makes
/// it a quantile of F rather than of chi-squared.
double loss_of(const FitOptions& options, int degrees_of_freedom) {
  if (options.overdispersed && degrees_of_freedom > 0)
    return boost::math::quantile(boost::math::fisher_f(1.0, degrees_of_freedom), options.confidence);
  return boost::math::quantile(boost::math::chi_squared(1.0), options.confidence);
}

Held held_in(const FitOptions& options) {
  return {false, false, options.lapse.has_value(), !options.overdispersed};
}

/// The same without overdispersion.
Problem binomial(Problem problem) {
  problem.upper[dispersion_index] = 0.0;
  return problem;
}

double deviance_of(const Problem& problem, double log_likelihood) {
  double saturated = 0.0;
  for (const Cell& cell : problem.cells) {
    const auto [k, n] = cell.answers;
    if (k > 0) saturated += k * std::log(static_cast<double>(k) / n);
    if (k < n) saturated += (n - k) * std::log(static_cast<double>(n - k) / n);
  }
  return std::max(0.0, 2.0 * (saturated - log_likelihood));
}

double overdispersion_p(const Problem& problem, const Maximum& best, Held held) {
  held[dispersion_index] = true;
  Point start = best.at;
  start[dispersion_index] = 0.0;
  const double without = maximise(binomial(problem), start, held).log_likelihood;
  const double ratio = 2.0 * (best.log_likelihood - without);
  if (ratio <= 0.0) return 1.0;
  return 0.5 * boost::math::cdf(boost::math::complement(boost::math::chi_squared(1.0), ratio));
}

}  // namespace

double ScaledAxis::intensity(double scaled) const {
  if (std::isinf(scaled)) return axis == Axis::linear || scaled > 0.0 ? scaled : 0.0;
  const double value = first + scaled * span;
  return axis == Axis::logarithmic ? std::exp(value) : value;
}

ScaledProblem scaled_problem(std::span<const Level> levels, const FitOptions& options) {
  const bool is_logarithmic = options.axis == Axis::logarithmic;
  require(options.shape != Shape::weibull || is_logarithmic, "a Weibull curve has a logarithmic axis");
  require(options.guess >= 0.0 && options.guess < 1.0, "the guess rate must lie in 0 to 1");
  require_probability(options.confidence, "the confidence");
  const double lapse = options.lapse.value_or(options.largest_lapse);
  require(lapse >= 0.0 && lapse < 0.5 * (1.0 - options.guess),
          "the lapse rate is too large for this guess rate");
  ScaledProblem result;
  Problem& problem = result.problem;
  problem.shape = options.shape;
  problem.guess = options.guess;
  problem.criterion = options.criterion.value_or(0.5 + 0.5 * options.guess);
  require(problem.criterion > options.guess && problem.criterion < 1.0 - lapse,
          "the criterion must lie above the guess rate and below one less the lapse rate");
  double least = infinite;
  double most = -infinite;
  for (const Level& level : levels) {
    require(level.answers);
    require(std::isfinite(level.intensity) && (!is_logarithmic || level.intensity >= 0.0),
            "an intensity must be finite, and not below zero on a logarithmic axis");
    if (level.answers.trials == 0) continue;
    const double at = is_logarithmic ? std::log(level.intensity) : level.intensity;
    problem.cells.push_back({.at = at, .answers = level.answers});
    if (std::isfinite(at)) {
      least = std::min(least, at);
      most = std::max(most, at);
    }
  }
  require(most > least, "a psychometric function needs answers at two intensities at least");
  result.axis = {.axis = options.axis, .first = least, .span = most - least};
  for (Cell& cell : problem.cells) cell.at = (cell.at - least) / (most - least);
  problem.lower = {-5.0, std::log(0.05), options.lapse.value_or(0.0), 0.0};
  problem.upper = {6.0, std::log(1000.0), lapse, options.overdispersed ? max_dispersion : 0.0};
  return result;
}

FoundCurve best_curve(const ScaledProblem& scaled, const FitOptions& options) {
  const Point like{0.5, 1.5, options.lapse.value_or(0.0), options.overdispersed ? 0.02 : 0.0};
  const Maximum best = maximise_from_many(scaled.problem, like, held_in(options));
  const Problem plain = binomial(scaled.problem);
  Point without = best.at;
  without[dispersion_index] = 0.0;
  return {.maximum = best, .deviance = deviance_of(plain, log_likelihood(plain, without))};
}

PsychometricFit fit_psychometric(std::span<const Level> levels, const FitOptions& options) {
  const ScaledProblem scaled = scaled_problem(levels, options);
  const FoundCurve found = best_curve(scaled, options);
  const auto [threshold, log_slope, lapse, dispersion] = found.maximum.at;
  const double slope = std::exp(log_slope);
  PsychometricFit fit;
  fit.curve = {
      .shape = options.shape,
      .axis = options.axis,
      .threshold = scaled.axis.intensity(threshold - criterion_quantile(scaled.problem, lapse) / slope),
      .slope = slope / scaled.axis.span,
      .guess = options.guess,
      .lapse = lapse};
  fit.slope = fit.curve.slope;
  fit.confidence = options.confidence;
  fit.log_likelihood = found.maximum.log_likelihood;
  fit.deviance = found.deviance;
  fit.degrees_of_freedom = static_cast<int>(scaled.problem.cells.size()) - (options.lapse ? 2 : 3) -
                           (options.overdispersed ? 1 : 0);
  fit.overdispersion = dispersion / (1.0 + dispersion);
  fit.slope_at_bound =
      log_slope <= scaled.problem.lower[slope_index] || log_slope >= scaled.problem.upper[slope_index];
  const Held held = held_in(options);
  const Profile profile(scaled.problem, found.maximum, held, loss_of(options, fit.degrees_of_freedom));
  fit.threshold = {.value = scaled.axis.intensity(threshold),
                   .criterion = scaled.problem.criterion,
                   .interval = {.lower = scaled.axis.intensity(profile.end(threshold_index, -1.0)),
                                .upper = scaled.axis.intensity(profile.end(threshold_index, 1.0))}};
  fit.slope_interval = {.lower = std::exp(profile.end(slope_index, -1.0)) / scaled.axis.span,
                        .upper = std::exp(profile.end(slope_index, 1.0)) / scaled.axis.span};
  if (options.overdispersed) fit.overdispersion_p = overdispersion_p(scaled.problem, found.maximum, held);
  return fit;
}

Threshold half_interquartile(const PsychometricFit& fit) {
  const double reach = 0.5 * (shape_quantile(fit.curve.shape, 0.75) - shape_quantile(fit.curve.shape, 0.25));
  const auto of = [&](double slope) {
    return fit.curve.axis == Axis::logarithmic ? std::expm1(reach / slope) : reach / slope;
  };
  return {.value = of(fit.slope),
          .criterion = 0.75,
          .interval = {.lower = of(fit.slope_interval.upper), .upper = of(fit.slope_interval.lower)}};
}

AcrossSubjects across_subjects(std::span<const PsychometricFit> fits, double confidence) {
  require_probability(confidence, "the confidence");
  require(fits.size() >= 2, "an interval across subjects needs two subjects at least");
  const Axis axis = fits[0].curve.axis;
  const auto n = static_cast<double>(fits.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const PsychometricFit& fit : fits) {
    require(fit.curve.axis == axis && fit.threshold.criterion == fits[0].threshold.criterion,
            "thresholds across subjects must have the same axis and criterion");
    const double value = axis == Axis::logarithmic ? std::log(fit.threshold.value) : fit.threshold.value;
    require(std::isfinite(value), "a subject's threshold is not finite");
    sum += value;
    squares += value * value;
  }
  const double mean = sum / n;
  const double deviation = std::sqrt(std::max(0.0, (squares - n * mean * mean) / (n - 1.0)));
  const double half = boost::math::quantile(boost::math::students_t(n - 1.0), 0.5 + 0.5 * confidence) *
                      deviation / std::sqrt(n);
  const auto back = [&](double value) { return axis == Axis::logarithmic ? std::exp(value) : value; };
  return {.mean = back(mean),
          .interval = {.lower = back(mean - half), .upper = back(mean + half)},
          .deviation = deviation};
}

}  // namespace kerf::psychophysics
