#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/minima.hpp>

#include <kerf/psychophysics/psychometric_fit.h>

#include "checks.h"
#include "likelihood.h"
#include "psychometric_problem.h"
#include "shape.h"

namespace kerf::psychophysics {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double most_dispersion = 9.0;  ///< rho = 0.9

double dispersion_of(double rho) { return rho / (1.0 - rho); }

struct Best {
  Maximum maximum;
  double rho = 0.0;
};

/// Over the parameters that are not held, and over the overdispersion where there is one. The search for the
/// latter walks on from the point last found.
Best best_of(Problem& problem, const Point& like, const Held& held, bool from_many, bool overdispersed) {
  problem.dispersion = 0.0;
  Best best{.maximum = from_many ? maximise_from_many(problem, like, held) : maximise(problem, like, held)};
  if (!overdispersed) return best;
  Point last = best.maximum.at;
  const auto loss = [&](double rho) {
    problem.dispersion = dispersion_of(rho);
    const Maximum found = maximise(problem, last, held);
    last = found.at;
    if (found.log_likelihood > best.maximum.log_likelihood) best = {.maximum = found, .rho = rho};
    return -found.log_likelihood;
  };
  // In the square root, for rho is small where it matters.
  boost::math::tools::brent_find_minima([&](double root) { return loss(root * root); }, 0.0,
                                        std::sqrt(most_dispersion / (1.0 + most_dispersion)), 26);
  return best;
}

/// Walks from the estimate until the loss of likelihood reaches the quantile, then halves.
class Profile {
 public:
  Profile(Problem problem, const Best& best, const Held& held, bool overdispersed, double confidence)
      : problem_(std::move(problem)),
        best_(best),
        held_(held),
        overdispersed_(overdispersed),
        loss_(boost::math::quantile(boost::math::chi_squared(1.0), confidence)) {}

  /// Minus or plus infinity where the bound is reached first.
  double end(std::size_t index, double direction) {
    Held held = held_;
    held[index] = true;
    Point like = best_.maximum.at;
    const double centre = like[index];
    const double bound = direction < 0.0 ? problem_.lower[index] : problem_.upper[index];
    double inside = centre;
    double outside = centre;
    double step = 0.05;
    while (true) {
      outside = inside + direction * step;
      if ((outside - bound) * direction >= 0.0) outside = bound;
      if (excess(index, outside, held, like) > 0.0) break;
      if (outside == bound) return direction * infinite;
      inside = outside;
      step *= 1.5;
    }
    for (int i = 0; i < 60 && std::abs(outside - inside) > 1e-9; ++i) {
      const double middle = 0.5 * (inside + outside);
      (excess(index, middle, held, like) > 0.0 ? outside : inside) = middle;
    }
    return 0.5 * (inside + outside);
  }

 private:
  double excess(std::size_t index, double value, const Held& held, Point& like) {
    like[index] = value;
    const Best found = best_of(problem_, like, held, false, overdispersed_);
    like = found.maximum.at;
    return 2.0 * (best_.maximum.log_likelihood - found.maximum.log_likelihood) - loss_;
  }

  Problem problem_;
  Best best_;
  Held held_;
  bool overdispersed_;
  double loss_;
};

double deviance_of(const Problem& problem, double log_likelihood) {
  double saturated = 0.0;
  for (const Cell& cell : problem.cells) {
    const auto [k, n] = cell.answers;
    if (k > 0) saturated += k * std::log(static_cast<double>(k) / n);
    if (k < n) saturated += (n - k) * std::log(static_cast<double>(n - k) / n);
  }
  return std::max(0.0, 2.0 * (saturated - log_likelihood));
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
  problem.lower = {-5.0, std::log(0.05), options.lapse.value_or(0.0)};
  problem.upper = {6.0, std::log(1000.0), lapse};
  return result;
}

FoundCurve best_curve(const ScaledProblem& scaled, const FitOptions& options) {
  Problem problem = scaled.problem;
  const Held held{false, false, options.lapse.has_value()};
  const Best best =
      best_of(problem, {0.5, 1.5, options.lapse.value_or(0.0)}, held, true, options.overdispersed);
  problem.dispersion = 0.0;
  const double binomial = log_likelihood(problem, best.maximum.at);
  return {.maximum = best.maximum, .rho = best.rho, .deviance = deviance_of(problem, binomial)};
}

PsychometricFit fit_psychometric(std::span<const Level> levels, const FitOptions& options) {
  const ScaledProblem scaled = scaled_problem(levels, options);
  const FoundCurve found = best_curve(scaled, options);
  const auto [threshold, log_slope, lapse] = found.maximum.at;
  const Held held{false, false, options.lapse.has_value()};
  const double slope = std::exp(log_slope);
  PsychometricFit fit;
  const double location = threshold - criterion_quantile(scaled.problem, lapse) / slope;
  fit.curve = {.shape = options.shape,
               .axis = options.axis,
               .threshold = scaled.axis.intensity(location),
               .slope = slope / scaled.axis.span,
               .guess = options.guess,
               .lapse = lapse};
  fit.slope = fit.curve.slope;
  fit.confidence = options.confidence;
  fit.log_likelihood = found.maximum.log_likelihood;
  fit.deviance = found.deviance;
  fit.degrees_of_freedom = static_cast<int>(scaled.problem.cells.size()) - (options.lapse ? 2 : 3) -
                           (options.overdispersed ? 1 : 0);
  fit.overdispersion = found.rho;
  fit.slope_at_bound =
      log_slope <= scaled.problem.lower[slope_index] || log_slope >= scaled.problem.upper[slope_index];
  Profile profile(scaled.problem, {.maximum = found.maximum, .rho = found.rho}, held, options.overdispersed,
                  options.confidence);
  fit.threshold = {.value = scaled.axis.intensity(threshold),
                   .criterion = scaled.problem.criterion,
                   .interval = {.lower = scaled.axis.intensity(profile.end(threshold_index, -1.0)),
                                .upper = scaled.axis.intensity(profile.end(threshold_index, 1.0))}};
  fit.slope_interval = {.lower = std::exp(profile.end(slope_index, -1.0)) / scaled.axis.span,
                        .upper = std::exp(profile.end(slope_index, 1.0)) / scaled.axis.span};
  if (options.overdispersed) {
    Problem plain = scaled.problem;
    const double without = maximise(plain, found.maximum.at, held).log_likelihood;
    const double ratio = std::max(0.0, 2.0 * (found.maximum.log_likelihood - without));
    if (ratio > 0.0)
      fit.overdispersion_p =
          0.5 * boost::math::cdf(boost::math::complement(boost::math::chi_squared(1.0), ratio));
  }
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
