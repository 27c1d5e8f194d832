#pragma once

#include <vector>

#include <kerf/psychophysics/binomial.h>

// Ratings of how sure somebody is that a signal was there: the ROC curve, its area, and the normal
// distributions behind it, whose variances may differ.

namespace kerf::psychophysics {

/// How often each category was named, from the surest "no" to the surest "yes", as many of both.
struct Ratings {
  std::vector<int> noise;   ///< of the trials without the signal
  std::vector<int> signal;  ///< of those with it
};

struct RocArea {
  double value = 0.5;
  double standard_error = 0.0;
  Interval interval{.lower = 0.0, .upper = 1.0};  ///< of the logit; 0 to 1 where nothing overlaps
};

/// Area below the ROC curve, in trapezia: the probability that a signal is rated above a noise, ties by half
/// [Bamber1975]; 1/2 by guessing, whatever the criteria. Error by [DeLong1988].
/// @throws std::invalid_argument: no trials of either kind, or another number of categories.
[[nodiscard]] RocArea roc_area(const Ratings& ratings, double confidence = 0.95);

struct NormalRoc {
  double mean = 0.0;       ///< of the signal, in deviations of the noise, from its mean
  double deviation = 1.0;  ///< of the signal, over that of the noise
  double mean_error = 0.0;
  double log_deviation_error = 0.0;  ///< of ln(deviation); 0 where it is held at 1
  std::vector<double> criteria;      ///< between the categories that were named, rising
  double d_a = 0.0;  ///< distance in root mean square deviations; d' where the variances are equal
  double d_a_error = 0.0;
  Interval d_a_interval;
  double area = 0.5;  ///< below the curve, P(d_a / sqrt2)
  double log_likelihood = 0.0;
  double deviance = 0.0;  ///< against free probabilities
  int degrees_of_freedom = 0;
};

/// Noise of N(0, 1) and a signal of N(mean, deviation^2), cut into categories by criteria c [DorfmanAlf1969]:
///
///     P(category j | noise) = P(c_j) - P(c_(j-1)),   P(category j | signal) = P(z_j) - P(z_(j-1)),
///
/// with z = (c - mean) / deviation, and d_a = mean / sqrt((1 + deviation^2) / 2) [SimpsonFitter1973],
/// by the largest likelihood (Fisher scoring, with the step halved where it overshoots). Errors are those of
/// the expected information, the interval of d_a is d_a +- z times its error. With `equal_variances` the
/// deviation is 1.
/// @throws std::invalid_argument: too few categories (three, two for equal variances), or answers that no
///         finite curve fits best, such as signals that are all rated above all noise.
[[nodiscard]] NormalRoc fit_normal_roc(const Ratings& ratings, bool equal_variances = false,
                                       double confidence = 0.95);

/// Whether the variances are equal: p of twice the difference of the two likelihoods, chi-squared of one
/// degree.
[[nodiscard]] double equal_variances_p(const NormalRoc& free, const NormalRoc& equal);

}  // namespace kerf::psychophysics
