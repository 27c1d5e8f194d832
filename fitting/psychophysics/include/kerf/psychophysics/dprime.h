#pragma once

#include <kerf/psychophysics/binomial.h>

// Signal detection theory: how far two renderings lie apart for an observer, in standard deviations of what
// the observer feels (d'), freed of the bias to one answer and of the design. Equal variances throughout.

namespace kerf::psychophysics {

/// How an unbiased observer decides in a trial that is either right or wrong. P is the normal distribution.
enum class Decision {
  forced_choice,     ///< m intervals, one holds the other rendering and the largest is named:
                     ///< pc = integral of phi(x - d') P(x)^(m - 1) dx [HackerRatcliff1979]
  oddity,            ///< three intervals, which is the odd one (triangle), by distances [Frijters1979]:
                     ///< pc = 2 int_0^inf [P(-x sqrt3 + d' sqrt(2/3)) + P(-x sqrt3 - d' sqrt(2/3))] phi(x) dx
  abx_independent,   ///< pc = P(d'/sqrt2) P(d'/2) + P(-d'/sqrt2) P(-d'/2)
  abx_differencing,  ///< pc = P(d'/sqrt2) P(d'/sqrt6) + P(-d'/sqrt2) P(-d'/sqrt6); both: [Macmillan1977].
                     ///< Differencing where stimuli rove, otherwise independent.
  same_different,    ///< two intervals, independent observations: pc = P(d'/2)^2 + P(-d'/2)^2
  /// Likewise by differencing, |x1 - x2| > k with the k that is right most often, cosh(d' k / 2) = exp(d'^2 /
  /// 4): pc = (1 + P((d' - k) / sqrt2) + P((-d' - k) / sqrt2) - 2 P(-k / sqrt2)) / 2; see same_different.h
  same_different_differencing,
  yes_no,  ///< one interval, with the signal or without: pc = P(d' / 2)
};

struct Task {
  Decision decision = Decision::forced_choice;
  int intervals = 2;  ///< of a forced choice: 2 to 32
};

/// Proportion of right answers by guessing: 1 / m, 1/3 or 1/2.
[[nodiscard]] double chance_of(const Task& task);

/// Of an unbiased observer. d' may be negative in a forced choice and in yes/no alone: the other one is then
/// named.
[[nodiscard]] double proportion_correct(const Task& task, double d_prime);

/// The other way. 1 gives infinity, and what is at or below chance gives 0, except in a forced choice and in
/// yes/no.
[[nodiscard]] double d_prime(const Task& task, double proportion_correct);

struct DPrime {
  double value = 0.0;  ///< finite: see estimate_d_prime
  double standard_error =
      0.0;  ///< by the delta method: infinite where d' = 0 has no slope (ABX, oddity, same-different)
  Interval interval;  ///< of Clopper and Pearson for the proportion, taken to d'; may end at infinity
};

/// d' of a task from its count of right answers. Where all or none are right the proportion is (k + 1/2) / (n
/// + 1) (log-linear, [Hautus1995]), for value and standard error, not for the interval.
[[nodiscard]] DPrime estimate_d_prime(const Task& task, Count correct, double confidence = 0.95);

/// Which rates get the log-linear correction (k + 1/2) / (n + 1).
enum class Correction { none, extremes, always };

/// Sensitivity and bias from two rates.
struct Detection {
  double d_prime = 0.0;
  double criterion = 0.0;  ///< c: > 0 leans to "no" (to "same", to the second interval)
  double standard_error = 0.0;
  double criterion_standard_error = 0.0;
  Interval interval;  ///< of d', by the likelihood ratio, without correction: may end at infinity
};

/// Yes/no: d' = z(H) - z(F), c = -(z(H) + z(F)) / 2, variances after Gourevitch and Galanter
/// [GourevitchGalanter1967]: var z = p (1 - p) / (n phi(z)^2). With Correction::none rates of 0 and 1 are
/// refused.
[[nodiscard]] Detection yes_no(Count hits, Count false_alarms, Correction correction = Correction::extremes,
                               double confidence = 0.95);

/// d' = z(H) - z(F) of exact rates in (0, 1), as of an observer whose probabilities are known.
[[nodiscard]] double yes_no_d_prime(double hit, double false_alarm);

/// Two intervals with a bias to one of them: `first` counts "first" when it was the first, `second` counts
/// "first" when it was the second. d' = (z(H) - z(F)) / sqrt2, and the criterion alike.
[[nodiscard]] Detection two_interval(Count first, Count second, Correction correction = Correction::extremes,
                                     double confidence = 0.95);

}  // namespace kerf::psychophysics
