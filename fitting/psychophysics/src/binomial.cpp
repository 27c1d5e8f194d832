#include <algorithm>
#include <cmath>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>

#include <kerf/psychophysics/binomial.h>

#include "checks.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

constexpr double as_likely = 1.0 + 1e-7;
constexpr int max_trials = 100000;

double at_most(int k, int trials, double p) {
  if (k < 0) return 0.0;
  if (k >= trials) return 1.0;
  return boost::math::cdf(boost::math::binomial(trials, p), k);
}

double at_least(int k, int trials, double p) {
  if (k <= 0) return 1.0;
  if (k > trials) return 0.0;
  return boost::math::cdf(boost::math::complement(boost::math::binomial(trials, p), k - 1));
}

/// The least k in [first, last] for which `holds`, which once true stays true; last + 1 if none.
template <typename Holds>
int first_that(int first, int last, const Holds& holds) {
  int end = last + 1;
  while (first < end) {
    const int middle = first + (end - first) / 2;
    if (holds(middle)) {
      end = middle;
    } else {
      first = middle + 1;
    }
  }
  return first;
}

double two_sided(Count count, double chance) {
  const auto [k, n] = count;
  const boost::math::binomial null(n, chance);
  const double mean = n * chance;
  const double bound = as_likely * boost::math::pdf(null, k);
  if (k == mean) return 1.0;
  if (k < mean) {
    const int other = first_that(static_cast<int>(std::ceil(mean)), n,
                                 [&](int i) { return boost::math::pdf(null, i) <= bound; });
    return std::min(1.0, at_most(k, n, chance) + at_least(other, n, chance));
  }
  const int other = first_that(0, static_cast<int>(std::floor(mean)),
                               [&](int i) { return boost::math::pdf(null, i) > bound; }) -
                    1;
  return std::min(1.0, at_most(other, n, chance) + at_least(k, n, chance));
}

void require_design(const BinomialDesign& design) {
  require_probability(design.chance, "the probability by chance");
  require_probability(design.level, "the level of the test");
  require(design.truth >= 0.0 && design.truth <= 1.0, "the true probability must lie in 0 to 1");
}

}  // namespace

double binomial_test(Count count, double chance, Alternative alternative) {
  require(count);
  require_probability(chance, "the probability by chance");
  if (count.trials == 0) return 1.0;
  if (alternative == Alternative::greater) return at_least(count.successes, count.trials, chance);
  if (alternative == Alternative::less) return at_most(count.successes, count.trials, chance);
  return two_sided(count, chance);
}

Interval clopper_pearson(Count count, double confidence) {
  require(count);
  require_probability(confidence, "the confidence");
  const auto [k, n] = count;
  const double tail = 0.5 * (1.0 - confidence);
  return {.lower = k == 0 ? 0.0 : boost::math::quantile(boost::math::beta_distribution<>(k, n - k + 1), tail),
          .upper = k == n ? 1.0
                          : boost::math::quantile(boost::math::complement(
                                boost::math::beta_distribution<>(k + 1, n - k), tail))};
}

Interval wilson(Count count, double confidence) {
  require_some(count);
  require_probability(confidence, "the confidence");
  const double n = count.trials;
  const double p = count.successes / n;
  const double z = normal_quantile(0.5 + 0.5 * confidence);
  const double centre = p + z * z / (2.0 * n);
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  const double scale = 1.0 + z * z / n;
  return {.lower = count.successes == 0 ? 0.0 : (centre - half) / scale,
          .upper = count.successes == count.trials ? 1.0 : (centre + half) / scale};
}

double binomial_power(const BinomialDesign& design, int trials) {
  require_design(design);
  require(trials > 0, "a design needs one trial at least");
  const auto refused = [&](int k) {
    return binomial_test({k, trials}, design.chance, design.alternative) <= design.level;
  };
  const int mean = static_cast<int>(std::floor(trials * design.chance));
  double power = 0.0;
  if (design.alternative != Alternative::greater) {
    const int kept = first_that(0, mean, [&](int k) { return !refused(k); });
    power += at_most(kept - 1, trials, design.truth);
  }
  if (design.alternative != Alternative::less)
    power += at_least(first_that(mean + 1, trials, refused), trials, design.truth);
  return std::min(power, 1.0);
}

int trials_for_power(const BinomialDesign& design, double power) {
  require_design(design);
  require_probability(power, "the power");
  const double difference = design.truth - design.chance;
  require(
      design.alternative == Alternative::greater ? difference > 0.0
      : design.alternative == Alternative::less  ? difference < 0.0
                                                 : difference != 0.0,
      "the truth does not differ from chance in the direction of the test, so no number of trials shows it");
  const double tail = design.alternative == Alternative::two_sided ? 0.5 * design.level : design.level;
  const double root = normal_quantile(1.0 - tail) * std::sqrt(design.chance * (1.0 - design.chance)) +
                      normal_quantile(power) * std::sqrt(design.truth * (1.0 - design.truth));
  const double approximate = std::max(root, 1.0) * std::max(root, 1.0) / (difference * difference);
  require(approximate < max_trials,
          "the difference is so small that it takes more than 100,000 trials to show it");
  int trials = static_cast<int>(1.2 * approximate) + 60;
  while (binomial_power(design, trials) < power) trials *= 2;
  while (trials > 1 && binomial_power(design, trials - 1) >= power) --trials;
  return trials;
}

}  // namespace kerf::psychophysics
