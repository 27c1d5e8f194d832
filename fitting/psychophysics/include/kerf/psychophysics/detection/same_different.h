#pragma once

#include <kerf/psychophysics/dprime.h>

// Same-different: two intervals, which play the same or not; d' from the rates of "different" when they were
// (hits) and when they were not (false alarms), freed of the tendency to say "same".

namespace kerf::psychophysics {

/// How an observer tells different from same. P is the normal distribution.
enum class SameRule {
  /// Where the difference of the two is large, |x1 - x2| > k, which is best where renderings rove from trial
  /// to trial:
  ///     F = 2 P(-k / sqrt2),   H = P((d' - k) / sqrt2) + P((-d' - k) / sqrt2)   [MacmillanCreelman2005],
  ///     chapter 9
  differencing,
  /// Where that is the likelier one. Of two fixed renderings, with a = d' / sqrt2 and u, v the difference and
  /// the sum of
  /// the two about the middle, each over sqrt2, the likelihood ratio of different to same is cosh(a u) /
  /// cosh(a v)
  /// [Noreen1981], [Dai1996], and "different" is said where it is above exp(k):
  ///     F = P(cosh(a u) > exp(k) cosh(a v)),  u ~ N(0, 1), v ~ N(a, 1);   H: with u ~ N(a, 1), v ~ N(0, 1)
  likelihood,
};

struct SameDifferentRates {
  double hit = 0.5;
  double false_alarm = 0.5;
};

/// d' >= 0; criterion k >= 0 by differencing, any by likelihood. Integrals to 1e-7.
[[nodiscard]] SameDifferentRates same_different_rates(SameRule rule, double d_prime, double criterion);

/// The criterion by differencing that is right most often, cosh(d' k / 2) = exp(d'^2 / 4); sqrt2 for d' = 0.
[[nodiscard]] double best_difference(double d_prime);

/// d' of exact rates in (0, 1), as of an observer whose probabilities are known; 0 where H <= F.
[[nodiscard]] double same_different_d_prime(SameRule rule, const SameDifferentRates& rates);

/// `hits` counts "different" when they were, `false_alarms` when they were not; the criterion is k, above 0
/// (by likelihood) leaning to "same". H <= F gives d' = 0. Errors by the delta method; the interval is that
/// of the likelihood ratio over all criteria, its lower end not below 0, its upper end infinite where the
/// answers do not close it.
[[nodiscard]] Detection same_different(SameRule rule, Count hits, Count false_alarms,
                                       Correction correction = Correction::extremes,
                                       double confidence = 0.95);

}  // namespace kerf::psychophysics
