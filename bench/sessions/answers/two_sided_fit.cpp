#include "answers/two_sided_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <kerf/psychophysics/equivalence.h>

namespace kerf::bench {
namespace {

using psychophysics::FitOptions;
using psychophysics::Interval;
using psychophysics::PsychometricFit;

constexpr std::array lapse_grid{0.0, 0.02, 0.04, 0.06};

/// A normal or a Student's quantity of unit error.
psychophysics::Estimate standard(double value, double degrees_of_freedom) {
  return {.value = value, .standard_error = 1.0, .degrees_of_freedom = degrees_of_freedom};
}

/// Twice the loss of log-likelihood that an interval of this confidence allows.
double loss_of(double confidence, double degrees_of_freedom) {
  const auto quantile = psychophysics::equivalent_estimate(
      standard(0.0, degrees_of_freedom), {.lower = -1.0, .upper = 1.0}, 0.5 * (1.0 - confidence));
  return quantile.interval.upper * quantile.interval.upper;
}

/// The other way.
double confidence_of(double loss, double degrees_of_freedom) {
  const auto tail = psychophysics::equivalent_estimate(standard(std::sqrt(loss), degrees_of_freedom),
                                                       {.lower = 0.0, .upper = HUGE_VAL}, 0.05);
  return 1.0 - 2.0 * tail.p;
}

Interval both(Interval a, Interval b) {
  return {.lower = std::min(a.lower, b.lower), .upper = std::max(a.upper, b.upper)};
}

FitOptions with_lapse(FitOptions options, double lapse) {
  options.guess = lapse;
  options.lapse = lapse;
  options.criterion = 0.5;
  return options;
}

}  // namespace

PsychometricFit fit_with_equal_lapses(std::span<const psychophysics::Level> levels,
                                      const FitOptions& options) {
  if (options.lapse) return psychophysics::fit_psychometric(levels, with_lapse(options, *options.lapse));
  std::vector<PsychometricFit> fits;
  for (const double lapse : lapse_grid)
    fits.push_back(psychophysics::fit_psychometric(levels, with_lapse(options, lapse)));
  const std::size_t best =
      static_cast<std::size_t>(std::max_element(fits.begin(), fits.end(),
                                                [](const PsychometricFit& a, const PsychometricFit& b) {
                                                  return a.log_likelihood + 1e-9 < b.log_likelihood;
                                                }) -
                               fits.begin());
  PsychometricFit result = fits[best];
  result.degrees_of_freedom -= 1;  // the lapse rate
  const double degrees_of_freedom = options.overdispersed ? std::max(0, fits[best].degrees_of_freedom) : 0;
  const double allowed = loss_of(options.confidence, degrees_of_freedom);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const double left = allowed - 2.0 * (result.log_likelihood - fits[i].log_likelihood);
    if (i == best || left < 1e-4) continue;
    FitOptions narrower = with_lapse(options, lapse_grid[i]);
    narrower.confidence = confidence_of(left, degrees_of_freedom);
    const PsychometricFit fit = psychophysics::fit_psychometric(levels, narrower);
    result.threshold.interval = both(result.threshold.interval, fit.threshold.interval);
    result.slope_interval = both(result.slope_interval, fit.slope_interval);
  }
  return result;
}

}  // namespace kerf::bench
