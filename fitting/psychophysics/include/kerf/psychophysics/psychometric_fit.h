#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/psychometric.h>

// Psychometric functions by maximum likelihood, with intervals and goodness of fit.

namespace kerf::psychophysics {

/// What was answered at one intensity. The same intensity may come several times (subjects, sessions,
/// trials).
struct Level {
  double intensity = 0.0;  ///< >= 0 on a logarithmic axis
  Count answers;           ///< right ones, or "more": what the curve is the probability of
};

struct FitOptions {
  Shape shape = Shape::weibull;
  Axis axis = Axis::logarithmic;
  double guess = 0.5;           ///< known: 1 / m in a forced choice, 0 where both ends are free of guessing
  std::optional<double> lapse;  ///< fixed at this; otherwise estimated in [0, largest_lapse]
  double largest_lapse = 0.06;  ///< [WichmannHill2001]
  std::optional<double> criterion;  ///< psi at the threshold; standard: guess + (1 - guess) / 2
  double confidence = 0.95;
  bool overdispersed = false;  ///< beta-binomial: for answers pooled over subjects or sessions
};

/// Where the curve reaches a probability: in a discrimination from a standard this is the JND at that
/// criterion.
struct Threshold {
  double value = 0.0;
  double criterion = 0.75;  ///< psi
  Interval interval;        ///< ends at 0 or infinity where the data do not close it
};

struct PsychometricFit {
  Psychometric curve;
  Threshold threshold;
  double slope = 0.0;  ///< of the curve
  Interval slope_interval;
  double confidence = 0.95;
  double log_likelihood = 0.0;    ///< without binomial coefficients, which no parameter changes
  double deviance = 0.0;          ///< against a free probability at each row, as binomial
  int degrees_of_freedom = 0;     ///< rows less parameters; may be negative
  double overdispersion = 0.0;    ///< rho, correlation of two answers within a row, in [0, 0.9]
  double overdispersion_p = 1.0;  ///< of rho = 0, by the likelihood ratio (half a chi-squared of one degree)
  bool slope_at_bound = false;    ///< a step or a flat line: the data do not say a slope
};

/// Largest likelihood over threshold, slope and lapse rate, from many starts by scoring with a trust region;
/// intervals where twice the loss of log-likelihood, everything else fitted again, stays under the quantile
/// of chi-squared (profile likelihood). Overdispersed:
///
///     P(k | n) ~ B(k + psi nu, n - k + (1 - psi) nu) / B(psi nu, (1 - psi) nu),   nu = (1 - rho) / rho
///
/// so that the variance of k is n psi (1 - psi) (1 + (n - 1) rho). Rows are taken as independent: subjects
/// who differ in their thresholds at all levels alike call for `across_subjects` besides.
[[nodiscard]] PsychometricFit fit_psychometric(std::span<const Level> levels, const FitOptions& options);

/// Half the way between the points where F is 25 and 75 %: the JND of a curve that goes from "less" to "more"
/// about a standard. On a logarithmic axis a fraction of the standard, exp(half the way) - 1.
[[nodiscard]] Threshold half_interquartile(const PsychometricFit& fit);

struct BootstrapOptions {
  int samples = 1000;
  std::uint64_t seed = 1;
};

struct Bootstrap {
  Interval threshold;  ///< percentiles of the fits
  Interval slope;
  double deviance_p = 1.0;  ///< (1 + fits to data of the curve with at least this deviance) / (1 + all)
  int samples = 0;
};

/// Parametric: experiments drawn from the fitted curve (with its overdispersion) and fitted again. The p of
/// the deviance holds for few trials a row, where chi-squared does not [WichmannHill2001].
[[nodiscard]] Bootstrap bootstrap(const PsychometricFit& fit, std::span<const Level> levels,
                                  const FitOptions& options, const BootstrapOptions& how = {});

/// Mean of the subjects' thresholds with Student's interval: what holds for the population that they come
/// from, for the spread between subjects is in it. On a logarithmic axis the geometric mean.
struct AcrossSubjects {
  double mean = 0.0;
  Interval interval;
  double deviation =
      0.0;  ///< between subjects, of ln(threshold) on a logarithmic axis; holds their errors too
};
[[nodiscard]] AcrossSubjects across_subjects(std::span<const PsychometricFit> fits, double confidence = 0.95);

}  // namespace kerf::psychophysics
