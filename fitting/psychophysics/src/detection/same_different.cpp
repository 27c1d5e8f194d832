#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <kerf/psychophysics/detection/same_different.h>

#include "detection/rates.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

using std::numbers::sqrt2;
constexpr double no_dprime = 1e-7;    ///< below which the rates are those of none
constexpr double normal_reach = 7.5;  ///< of a normal distribution, in its deviations

constexpr unsigned exact_bits = 46;
constexpr unsigned interval_bits = 20;  ///< 1e-6 of an end: more than its answers say

template <typename Function>
double root_between(const Function& function, double lower, double upper, unsigned bits = exact_bits) {
  std::uintmax_t rounds = 200;
  const auto found = boost::math::tools::toms748_solve(
      function, lower, upper, boost::math::tools::eps_tolerance<double>(bits), rounds);
  return 0.5 * (found.first + found.second);
}

/// Integral of phi(x - centre) f(x) dx, in two parts about 0, where f may bend.
template <typename Function>
double expected(double centre, const Function& function) {
  using Rule = boost::math::quadrature::gauss<double, 40>;
  const auto weighted = [&](double x) { return normal_density(x - centre) * function(x); };
  const double from = centre - normal_reach;
  const double to = centre + normal_reach;
  if (from >= 0.0 || to <= 0.0) return Rule::integrate(weighted, from, to);
  return Rule::integrate(weighted, from, 0.0) + Rule::integrate(weighted, 0.0, to);
}

/// |u| from which on cosh(a u) > exp(a kappa) cosh(a v), kappa >= 0: acosh(exp(L)) / a, in logarithms.
double bound_of(double a, double kappa, double v) {
  const double x = a * std::abs(v);
  const double log_cosh = x + std::log1p(std::exp(-2.0 * x)) - std::numbers::ln2;
  const double log_argument = a * kappa + log_cosh;
  if (log_argument > 20.0) return (log_argument + std::numbers::ln2) / a;
  const double over = std::expm1(log_argument);  // acosh(1 + over)
  return std::log1p(over + std::sqrt(over * (over + 2.0))) / a;
}

/// By likelihood, kappa = k / a: of the same size as the observations, however small a is.
SameDifferentRates rates_by_likelihood(double d, double kappa) {
  const double a = d / sqrt2;
  const double size = std::abs(kappa);
  const double none_apart =
      expected(a, [&](double v) { return 2.0 * normal_probability(-bound_of(a, size, v)); });
  const double apart = expected(0.0, [&](double v) {
    const double t = bound_of(a, size, v);
    return normal_probability(a - t) + normal_probability(-a - t);
  });
  // Sum and difference change places where "same" has to be the likelier one by as much.
  if (kappa >= 0.0) return {.hit = apart, .false_alarm = none_apart};
  return {.hit = 1.0 - none_apart, .false_alarm = 1.0 - apart};
}

SameDifferentRates rates_by_differencing(double d, double k) {
  return {.hit = normal_probability((d - k) / sqrt2) + normal_probability((-d - k) / sqrt2),
          .false_alarm = 2.0 * normal_probability(-k / sqrt2)};
}

/// d' > 0; `kappa` is the criterion, by likelihood over a.
SameDifferentRates rates_at(SameRule rule, double d, double kappa) {
  return rule == SameRule::differencing ? rates_by_differencing(d, kappa) : rates_by_likelihood(d, kappa);
}

std::pair<double, double> criteria(SameRule rule, double d) {
  const double widest = d / sqrt2 + 2.0 * normal_reach;
  return {rule == SameRule::differencing ? 0.0 : -widest, widest};
}

/// The criterion that has this rate of false alarms.
double criterion_at(SameRule rule, double d, double false_alarm) {
  if (rule == SameRule::differencing) return -sqrt2 * normal_quantile(0.5 * false_alarm);
  const auto [lower, upper] = criteria(rule, d);
  return root_between([&](double kappa) { return rates_at(rule, d, kappa).false_alarm - false_alarm; }, lower,
                      upper);
}

double d_prime_of(SameRule rule, const SameDifferentRates& rates) {
  if (rates.hit <= rates.false_alarm) return 0.0;
  const auto excess = [&](double d) {
    return rates_at(rule, d, criterion_at(rule, d, rates.false_alarm)).hit - rates.hit;
  };
  constexpr double most = 2.0 * largest_dprime;
  if (excess(no_dprime) >= 0.0) return 0.0;
  if (excess(most) <= 0.0) return infinite;
  return root_between(excess, no_dprime, most);
}

/// Errors of d' and criterion: the rates' through the inverse of their slopes.
void add_errors(SameRule rule, double kappa, double variance_of_hit, double variance_of_false_alarm,
                Detection& result) {
  constexpr double step = 1e-4;
  const double d = result.d_prime;
  const auto slopes = [&](double d_step, double kappa_step) {
    const SameDifferentRates above = rates_at(rule, d + d_step, kappa + kappa_step);
    const SameDifferentRates below = rates_at(rule, d - d_step, kappa - kappa_step);
    return std::pair((above.hit - below.hit) / (2.0 * step),
                     (above.false_alarm - below.false_alarm) / (2.0 * step));
  };
  const auto [hit_by_d, alarm_by_d] = slopes(step, 0.0);
  const auto [hit_by_k, alarm_by_k] = slopes(0.0, step);
  const double determinant = hit_by_d * alarm_by_k - hit_by_k * alarm_by_d;
  result.standard_error =
      std::sqrt(alarm_by_k * alarm_by_k * variance_of_hit + hit_by_k * hit_by_k * variance_of_false_alarm) /
      std::abs(determinant);
  result.criterion_standard_error =
      std::sqrt(alarm_by_d * alarm_by_d * variance_of_hit + hit_by_d * hit_by_d * variance_of_false_alarm) /
      std::abs(determinant);
  if (rule == SameRule::likelihood) result.criterion_standard_error *= d / sqrt2;
}

/// Largest log-likelihood over all criteria.
double profile_of(SameRule rule, Count hits, Count false_alarms, double d) {
  if (d < no_dprime) {
    const double both =
        static_cast<double>(hits.successes + false_alarms.successes) / (hits.trials + false_alarms.trials);
    return log_probability(hits, both) + log_probability(false_alarms, both);
  }
  const auto loss = [&](double kappa) {
    const SameDifferentRates rates = rates_at(rule, d, kappa);
    return -log_probability(hits, rates.hit) - log_probability(false_alarms, rates.false_alarm);
  };
  const auto [lower, upper] = criteria(rule, d);
  return -boost::math::tools::brent_find_minima(loss, lower, upper, interval_bits).second;
}

Interval interval_of(SameRule rule, Count hits, Count false_alarms, double d, double confidence) {
  const double z = normal_quantile(0.5 + 0.5 * confidence);
  const double h = static_cast<double>(hits.successes) / hits.trials;
  const double f = static_cast<double>(false_alarms.successes) / false_alarms.trials;
  const double best = h > f ? log_probability(hits, h) + log_probability(false_alarms, f)
                            : profile_of(rule, hits, false_alarms, 0.0);
  const auto excess = [&](double trial) {
    return 2.0 * (best - profile_of(rule, hits, false_alarms, trial)) - z * z;
  };
  const double middle = std::min(d, largest_dprime);
  return {.lower = excess(0.0) <= 0.0 ? 0.0 : root_between(excess, no_dprime, middle, interval_bits),
          .upper = excess(largest_dprime) <= 0.0
                       ? infinite
                       : root_between(excess, middle, largest_dprime, interval_bits)};
}

}  // namespace

SameDifferentRates same_different_rates(SameRule rule, double d_prime, double criterion) {
  require(d_prime >= 0.0 && d_prime <= 2.0 * largest_dprime, "d' of same-different must lie in 0 to 28");
  require(std::isfinite(criterion) && (rule == SameRule::likelihood || criterion >= 0.0),
          "the criterion of same-different must be a number, by differencing not below 0");
  if (rule == SameRule::differencing) return rates_by_differencing(d_prime, criterion);
  if (d_prime < no_dprime) {
    const double rate = criterion > 0.0 ? 0.0 : criterion < 0.0 ? 1.0 : 0.5;
    return {.hit = rate, .false_alarm = rate};
  }
  return rates_by_likelihood(d_prime, criterion * sqrt2 / d_prime);
}

double best_difference(double d_prime) {
  if (d_prime < 1e-8) return sqrt2;
  // In logarithms: the exponential leaves the range of a double for large d'.
  const double log_argument = 0.25 * d_prime * d_prime;
  if (log_argument > 40.0) return 2.0 * (log_argument + std::numbers::ln2) / d_prime;
  const double over = std::expm1(log_argument);
  return 2.0 * std::log1p(over + std::sqrt(over * (over + 2.0))) / d_prime;
}

double same_different_d_prime(SameRule rule, const SameDifferentRates& rates) {
  require_probability(rates.hit, "the rate of hits");
  require_probability(rates.false_alarm, "the rate of false alarms");
  return d_prime_of(rule, rates);
}

Detection same_different(SameRule rule, Count hits, Count false_alarms, Correction correction,
                         double confidence) {
  require_probability(confidence, "the confidence");
  const SameDifferentRates rates{.hit = corrected(hits, correction),
                                 .false_alarm = corrected(false_alarms, correction)};
  Detection result{.d_prime = d_prime_of(rule, rates),
                   .criterion = 0.0,
                   .standard_error = infinite,
                   .criterion_standard_error = infinite};
  result.interval = interval_of(rule, hits, false_alarms, result.d_prime, confidence);
  if (result.d_prime == 0.0) {
    if (rule == SameRule::differencing) result.criterion = criterion_at(rule, 0.0, rates.false_alarm);
    return result;
  }
  const double kappa = criterion_at(rule, result.d_prime, rates.false_alarm);
  result.criterion = rule == SameRule::likelihood ? kappa * result.d_prime / sqrt2 : kappa;
  add_errors(rule, kappa, rates.hit * (1.0 - rates.hit) / hits.trials,
             rates.false_alarm * (1.0 - rates.false_alarm) / false_alarms.trials, result);
  return result;
}

}  // namespace kerf::psychophysics
