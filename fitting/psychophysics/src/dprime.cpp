#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <kerf/psychophysics/detection/same_different.h>
#include <kerf/psychophysics/dprime.h>

#include "checks.h"
#include "detection/rates.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

using std::numbers::sqrt2;
using std::numbers::sqrt3;

/// The trapezium rule converges faster than any power for what falls off as a normal density does.
template <typename Function>
double integral(double from, double to, const Function& function) {
  constexpr int steps = 400;
  const double width = (to - from) / steps;
  double sum = 0.5 * (function(from) + function(to));
  for (int i = 1; i < steps; ++i) sum += function(from + i * width);
  return width * sum;
}

double forced_choice(double d, int intervals) {
  if (intervals == 2) return normal_probability(d / sqrt2);
  return integral(d - 9.0, d + 9.0, [&](double x) {
    return normal_density(x - d) * std::pow(normal_probability(x), intervals - 1);
  });
}

double oddity(double d) {
  const double shift = d * sqrt2 / sqrt3;
  return 2.0 * boost::math::quadrature::gauss<double, 60>::integrate(
                   [&](double x) {
                     return normal_density(x) *
                            (normal_probability(shift - x * sqrt3) + normal_probability(-shift - x * sqrt3));
                   },
                   0.0, 9.0);
}

double product(double a, double b) {
  return normal_probability(a) * normal_probability(b) + normal_probability(-a) * normal_probability(-b);
}

double differencing(double d) {
  const SameDifferentRates rates = same_different_rates(SameRule::differencing, d, best_difference(d));
  return 0.5 + 0.5 * (rates.hit - rates.false_alarm);
}

/// Of which d' may be below 0.
bool is_signed(Decision decision) {
  return decision == Decision::forced_choice || decision == Decision::yes_no;
}

void require_task(const Task& task) {
  require(task.decision != Decision::forced_choice || (task.intervals >= 2 && task.intervals <= 32),
          "a forced choice has 2 to 32 intervals, not " + std::to_string(task.intervals));
}

double slope(const Task& task, double d) {
  constexpr double step = 1e-4;
  const double lower = is_signed(task.decision) ? d - step : std::max(0.0, d - step);
  return (proportion_correct(task, d + step) - proportion_correct(task, lower)) / (d + step - lower);
}

template <typename Function>
double root(const Function& function, double lower, double upper) {
  std::uintmax_t rounds = 200;
  const auto found = boost::math::tools::toms748_solve(function, lower, upper,
                                                       boost::math::tools::eps_tolerance<double>(48), rounds);
  return 0.5 * (found.first + found.second);
}

double variance_of_z(double rate, int trials) {
  const double density = normal_density(normal_quantile(rate));
  return rate * (1.0 - rate) / (trials * density * density);
}

/// Largest over the criterion of the log-likelihood of two rates whose z lie `separation` apart: concave.
double profile(Count hits, Count false_alarms, double separation) {
  const auto loss = [&](double centre) {
    return -log_probability(hits, normal_probability(centre + 0.5 * separation)) -
           log_probability(false_alarms, normal_probability(centre - 0.5 * separation));
  };
  const double reach = 8.0 + 0.5 * std::abs(separation);
  constexpr int bits = std::numeric_limits<double>::digits / 2;
  return -boost::math::tools::brent_find_minima(loss, -reach, reach, bits).second;
}

Interval likelihood_interval(Count hits, Count false_alarms, double confidence) {
  const double z = normal_quantile(0.5 + 0.5 * confidence);
  const double h = static_cast<double>(hits.successes) / hits.trials;
  const double f = static_cast<double>(false_alarms.successes) / false_alarms.trials;
  const double best = log_probability(hits, h) + log_probability(false_alarms, f);
  const auto excess = [&](double d) { return 2.0 * (best - profile(hits, false_alarms, d)) - z * z; };
  const double middle = std::clamp(
      normal_quantile(std::clamp(h, 1e-9, 1.0 - 1e-9)) - normal_quantile(std::clamp(f, 1e-9, 1.0 - 1e-9)),
      -largest_dprime, largest_dprime);
  return {.lower = excess(-largest_dprime) <= 0.0 ? -infinite : root(excess, -largest_dprime, middle),
          .upper = excess(largest_dprime) <= 0.0 ? infinite : root(excess, middle, largest_dprime)};
}

/// Two rates whose z lie `scale` d' apart.
Detection from_rates(Count hits, Count false_alarms, Correction correction, double confidence, double scale) {
  require_probability(confidence, "the confidence");
  const double h = corrected(hits, correction);
  const double f = corrected(false_alarms, correction);
  const double variance = variance_of_z(h, hits.trials) + variance_of_z(f, false_alarms.trials);
  const Interval interval = likelihood_interval(hits, false_alarms, confidence);
  return {.d_prime = (normal_quantile(h) - normal_quantile(f)) / scale,
          .criterion = -0.5 * (normal_quantile(h) + normal_quantile(f)) / scale,
          .standard_error = std::sqrt(variance) / scale,
          .criterion_standard_error = 0.5 * std::sqrt(variance) / scale,
          .interval = {.lower = interval.lower / scale, .upper = interval.upper / scale}};
}

}  // namespace

double chance_of(const Task& task) {
  require_task(task);
  if (task.decision == Decision::forced_choice) return 1.0 / task.intervals;
  return task.decision == Decision::oddity ? 1.0 / 3.0 : 0.5;
}

double proportion_correct(const Task& task, double d) {
  require_task(task);
  require(!std::isnan(d) && (d >= 0.0 || is_signed(task.decision)),
          "d' is " + std::to_string(d) +
              "; it must be a number, and only that of a forced choice or of yes/no may be negative");
  d = std::clamp(d, -2.0 * largest_dprime, 2.0 * largest_dprime);
  switch (task.decision) {
    case Decision::forced_choice:
      return forced_choice(d, task.intervals);
    case Decision::oddity:
      return oddity(d);
    case Decision::abx_independent:
      return product(d / sqrt2, 0.5 * d);
    case Decision::abx_differencing:
      return product(d / sqrt2, d / (sqrt2 * sqrt3));
    case Decision::same_different:
      return product(0.5 * d, 0.5 * d);
    case Decision::same_different_differencing:
      return differencing(d);
    case Decision::yes_no:
      return normal_probability(0.5 * d);
  }
  return 0.0;
}

double d_prime(const Task& task, double proportion) {
  require_task(task);
  require(proportion >= 0.0 && proportion <= 1.0, "a proportion of right answers lies in 0 to 1");
  const bool may_be_negative = is_signed(task.decision);
  if (!may_be_negative && proportion <= chance_of(task)) return 0.0;
  if (task.decision == Decision::yes_no) return 2.0 * normal_quantile(proportion);
  if (may_be_negative && task.intervals == 2) return sqrt2 * normal_quantile(proportion);
  const auto excess = [&](double d) { return proportion_correct(task, d) - proportion; };
  const double least = may_be_negative ? -largest_dprime : 0.0;
  if (proportion >= 1.0 || excess(largest_dprime) <= 0.0) return infinite;
  if (proportion <= 0.0 || excess(least) >= 0.0) return may_be_negative ? -infinite : 0.0;
  return root(excess, least, largest_dprime);
}

DPrime estimate_d_prime(const Task& task, Count correct, double confidence) {
  const double rate = corrected(correct, Correction::extremes);
  const Interval of_rate = clopper_pearson(correct, confidence);
  const double value = d_prime(task, rate);
  const double steepness = slope(task, value);
  return {.value = value,
          .standard_error = std::abs(value) < 1e-9 && !is_signed(task.decision)
                                ? infinite
                                : std::sqrt(rate * (1.0 - rate) / correct.trials) / steepness,
          .interval = {.lower = d_prime(task, of_rate.lower), .upper = d_prime(task, of_rate.upper)}};
}

Detection yes_no(Count hits, Count false_alarms, Correction correction, double confidence) {
  return from_rates(hits, false_alarms, correction, confidence, 1.0);
}

double yes_no_d_prime(double hit, double false_alarm) {
  return normal_quantile(hit) - normal_quantile(false_alarm);
}

Detection two_interval(Count first, Count second, Correction correction, double confidence) {
  return from_rates(first, second, correction, confidence, sqrt2);
}

}  // namespace kerf::psychophysics
