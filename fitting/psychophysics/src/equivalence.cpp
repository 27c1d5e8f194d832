#include <algorithm>
#include <cmath>
#include <string>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <kerf/psychophysics/equivalence.h>

#include "checks.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

void require_margin(double centre, double margin, double level) {
  require_probability(centre, "the centre");
  require(margin > 0.0 && std::isfinite(margin), "the margin must be above zero");
  require(level > 0.0 && level < 0.5, "the level of an equivalence test must lie between 0 and 0.5");
}

double larger_p(Count count, double centre, double margin) {
  const double lower = centre - margin;
  const double upper = centre + margin;
  const double above = lower <= 0.0 ? 0.0 : binomial_test(count, lower, Alternative::greater);
  const double below = upper >= 1.0 ? 0.0 : binomial_test(count, upper, Alternative::less);
  return std::max(above, below);
}

}  // namespace

Equivalence equivalent_proportion(Count count, double centre, double margin, double level) {
  require_some(count);
  require_margin(centre, margin, level);
  const double p = larger_p(count, centre, margin);
  return {.p = p, .interval = clopper_pearson(count, 1.0 - 2.0 * level), .is_shown = p <= level};
}

double excluded_margin(Count count, double centre, double level) {
  require_some(count);
  require_margin(centre, 1.0, level);
  const Interval interval = clopper_pearson(count, 1.0 - 2.0 * level);
  return std::max(centre - interval.lower, interval.upper - centre);
}

Equivalence below_d_prime(const Task& task, Count correct, double bound, double level) {
  require_some(correct);
  require(bound > 0.0, "the bound of d' must be above zero");
  require(level > 0.0 && level < 0.5, "the level of an equivalence test must lie between 0 and 0.5");
  const double proportion = proportion_correct(task, bound);
  const double p = proportion >= 1.0 ? (correct.successes == correct.trials ? 1.0 : 0.0)
                                     : binomial_test(correct, proportion, Alternative::less);
  const Interval of_rate = clopper_pearson(correct, 1.0 - 2.0 * level);
  return {.p = p,
          .interval = {.lower = d_prime(task, of_rate.lower), .upper = d_prime(task, of_rate.upper)},
          .is_shown = p <= level};
}

double excluded_d_prime(const Task& task, Count correct, double level) {
  require_some(correct);
  require(level > 0.0 && level < 0.5, "the level of an equivalence test must lie between 0 and 0.5");
  return d_prime(task, clopper_pearson(correct, 1.0 - 2.0 * level).upper);
}

Equivalence equivalent_estimate(const Estimate& estimate, Interval margins, double level) {
  require(estimate.standard_error > 0.0 && std::isfinite(estimate.value),
          "an estimate needs a standard error above zero");
  require(margins.lower < margins.upper, "the lower margin must lie under the upper one");
  require(level > 0.0 && level < 0.5, "the level of an equivalence test must lie between 0 and 0.5");
  const double f = estimate.degrees_of_freedom;
  const auto tail = [&](double z) {
    return f > 0.0 ? boost::math::cdf(boost::math::students_t(f), z) : normal_probability(z);
  };
  const double quantile =
      f > 0.0 ? boost::math::quantile(boost::math::students_t(f), 1.0 - level) : normal_quantile(1.0 - level);
  const double p = std::max(tail((margins.lower - estimate.value) / estimate.standard_error),
                            tail((estimate.value - margins.upper) / estimate.standard_error));
  return {.p = p,
          .interval = {.lower = estimate.value - quantile * estimate.standard_error,
                       .upper = estimate.value + quantile * estimate.standard_error},
          .is_shown = p <= level};
}

double equivalence_power(const EquivalenceDesign& design, int trials) {
  require_margin(design.centre, design.margin, design.level);
  require_probability(design.truth, "the true probability");
  require(trials > 0, "a design needs one trial at least");
  const boost::math::binomial truth(trials, design.truth);
  const int middle = static_cast<int>(std::lround(trials * design.centre));
  const auto shown = [&](int k) {
    return larger_p({k, trials}, design.centre, design.margin) <= design.level;
  };
  double power = 0.0;
  for (int k = middle; k >= 0 && shown(k); --k) power += boost::math::pdf(truth, k);
  for (int k = middle + 1; k <= trials && shown(k); ++k) power += boost::math::pdf(truth, k);
  return std::min(1.0, power);
}

int trials_for_equivalence(const EquivalenceDesign& design, double power) {
  require_margin(design.centre, design.margin, design.level);
  require_probability(power, "the power");
  const double room = design.margin - std::abs(design.truth - design.centre);
  require(room > 0.0, "the truth lies outside the margin, so no number of trials shows that it is inside");
  require(room > 0.005, "the margin is so narrow that it takes more than 100,000 trials");
  const double z = normal_quantile(1.0 - design.level) + normal_quantile(0.5 + 0.5 * power);
  int trials = static_cast<int>(1.2 * z * z * 0.25 / (room * room)) + 60;
  while (equivalence_power(design, trials) < power) trials *= 2;
  while (trials > 1 && equivalence_power(design, trials - 1) >= power) --trials;
  return trials;
}

}  // namespace kerf::psychophysics
