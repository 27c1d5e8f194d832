#pragma once

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/dprime.h>

// "No difference larger than this is likely": what a test that found nothing does not say. The two one-sided
// tests of Schuirmann [Schuirmann1987], each at the level; the same as an interval of confidence 1 - 2 level
// that lies within the margins.

namespace kerf::psychophysics {

struct Equivalence {
  double p = 1.0;         ///< the larger of the two tests'
  Interval interval;      ///< of confidence 1 - 2 level
  bool is_shown = false;  ///< p <= level
};

/// Of a proportion: is it within centre +- margin? Exact: P(X >= k | centre - margin) and P(X <= k | centre +
/// margin). A margin that leaves 0 to 1 at one end needs no test there.
[[nodiscard]] Equivalence equivalent_proportion(Count count, double centre, double margin,
                                                double level = 0.05);

/// The least margin about the centre that equivalent_proportion would grant: no difference larger than this
/// is likely.
[[nodiscard]] double excluded_margin(Count count, double centre, double level = 0.05);

/// Of a discrimination: is d' below a bound? One-sided and exact, P(X <= k | pc(bound)); bound > 0.
[[nodiscard]] Equivalence below_d_prime(const Task& task, Count correct, double bound, double level = 0.05);

/// The least d' that is excluded at the level. Infinity where all answers are right.
[[nodiscard]] double excluded_d_prime(const Task& task, Count correct, double level = 0.05);

/// Of an estimate with a standard error (a difference of d', of ln JND): within `margins`? Normal, or
/// Student's t where degrees_of_freedom > 0.
struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;  ///< > 0
  double degrees_of_freedom = 0.0;
};
[[nodiscard]] Equivalence equivalent_estimate(const Estimate& estimate, Interval margins,
                                              double level = 0.05);

/// Of anything with an interval of its own (a JND by profile likelihood): the interval must be one of
/// confidence 1 - 2 level, 90 % for a level of 5 %.
[[nodiscard]] constexpr bool lies_within(Interval interval, Interval margins) {
  return interval.lower > margins.lower && interval.upper < margins.upper;
}

/// Probability that equivalent_proportion shows it if the proportion is `truth`, and the least number of
/// trials from which on that stays at `power`.
struct EquivalenceDesign {
  double centre = 0.5;
  double margin = 0.1;
  double truth = 0.5;
  double level = 0.05;
};
[[nodiscard]] double equivalence_power(const EquivalenceDesign& design, int trials);
[[nodiscard]] int trials_for_equivalence(const EquivalenceDesign& design, double power = 0.8);

}  // namespace kerf::psychophysics
