#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <kerf/psychophysics/dprime.h>

#include "checks.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

using std::numbers::sqrt2;
using std::numbers::sqrt3;
constexpr double largest_dprime = 14.0;  ///< d' beyond which a proportion is 1 in double precision

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

void require_task(const Task& task) {
  require(task.decision != Decision::forced_choice || (task.intervals >= 2 && task.intervals <= 32),
          "a forced choice has 2 to 32 intervals, not " + std::to_string(task.intervals));
}

double slope(const Task& task, double d) {
  constexpr double step = 1e-4;
  const double lower = task.decision == Decision::forced_choice ? d - step : std::max(0.0, d - step);
  return (proportion_correct(task, d + step) - proportion_correct(task, lower)) / (d + step - lower);
}

template <typename Function>
double root(const Function& function, double lower, double upper) {
  std::uintmax_t rounds = 200;
  const auto found = boost::math::tools::toms748_solve(function, lower, upper,
                                                       boost::math::tools::eps_tolerance<double>(48), rounds);
  return 0.5 * (found.first + found.second);
}

double corrected(Count count, Correction correction) {
  require_some(count);
  const bool extreme = count.successes == 0 || count.successes == count.trials;
  require(!extreme || correction != Correction::none,
          "a rate of 0 or 1 has no finite z: allow the log-linear correction, or gather more trials");
  if (correction == Correction::always || (correction == Correction::extremes && extreme))
    return (count.successes + 0.5) / (count.trials + 1.0);
  return static_cast<double>(count.successes) / count.trials;
}

double variance_of_z(double rate, int trials) {
  const double density = normal_density(normal_quantile(rate));
  return rate * (1.0 - rate) / (trials * density * density);
}

double log_probability(Count count, double rate) {
  double sum = 0.0;
  if (count.successes > 0) sum += count.successes * std::log(std::max(rate, 1e-300));
  if (count.successes < count.trials) {
    sum += (count.trials - count.successes) * std::log(std::max(1.0 - rate, 1e-300));
  }
  return sum;
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
  require(!std::isnan(d) && (d >= 0.0 || task.decision == Decision::forced_choice),
          "d' is " + std::to_string(d) +
              "; it must be a number, and only that of a forced choice may be negative");
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
  }
  return 0.0;
}

double d_prime(const Task& task, double proportion) {
  require_task(task);
  require(proportion >= 0.0 && proportion <= 1.0, "a proportion of right answers lies in 0 to 1");
  const bool is_signed = task.decision == Decision::forced_choice;
  if (!is_signed && proportion <= chance_of(task)) return 0.0;
  if (is_signed && task.intervals == 2) return sqrt2 * normal_quantile(proportion);
  const auto excess = [&](double d) { return proportion_correct(task, d) - proportion; };
  const double least = is_signed ? -largest_dprime : 0.0;
  if (proportion >= 1.0 || excess(largest_dprime) <= 0.0) return infinite;
  if (proportion <= 0.0 || excess(least) >= 0.0) return is_signed ? -infinite : 0.0;
  return root(excess, least, largest_dprime);
}

DPrime estimate_d_prime(const Task& task, Count correct, double confidence) {
  const double rate = corrected(correct, Correction::extremes);
  const Interval of_rate = clopper_pearson(correct, confidence);
  const double value = d_prime(task, rate);
  const double steepness = slope(task, value);
  return {.value = value,
          .standard_error = std::abs(value) < 1e-9 && task.decision != Decision::forced_choice
                                ? infinite
                                : std::sqrt(rate * (1.0 - rate) / correct.trials) / steepness,
          .interval = {.lower = d_prime(task, of_rate.lower), .upper = d_prime(task, of_rate.upper)}};
}

Detection yes_no(Count hits, Count false_alarms, Correction correction, double confidence) {
  return from_rates(hits, false_alarms, correction, confidence, 1.0);
}

Detection two_interval(Count first, Count second, Correction correction, double confidence) {
  return from_rates(first, second, correction, confidence, sqrt2);
}

Detection same_different(Count hits, Count false_alarms, Correction correction, double confidence) {
  require_probability(confidence, "the confidence");
  const double h = corrected(hits, correction);
  const double f = corrected(false_alarms, correction);
  const double criterion = -sqrt2 * normal_quantile(0.5 * f);
  const auto hit_rate = [&](double d, double k) {
    return normal_probability((d - k) / sqrt2) + normal_probability((-d - k) / sqrt2);
  };
  // F = 2 P(-k / sqrt2), so dk/dF = -1 / (sqrt2 phi(k / sqrt2)).
  const double dk_df = -1.0 / (sqrt2 * normal_density(criterion / sqrt2));
  const double criterion_error = std::abs(dk_df) * std::sqrt(f * (1.0 - f) / false_alarms.trials);
  Detection result{.d_prime = 0.0,
                   .criterion = criterion,
                   .standard_error = infinite,
                   .criterion_standard_error = criterion_error,
                   .interval = {.lower = 0.0, .upper = infinite}};
  if (h <= f) return result;
  const double d =
      root([&](double trial) { return hit_rate(trial, criterion) - h; }, 0.0, 4.0 * largest_dprime);
  const double near = normal_density((d - criterion) / sqrt2) / sqrt2;
  const double far = normal_density((-d - criterion) / sqrt2) / sqrt2;
  const double dd_dh = 1.0 / (near - far);
  const double dd_df = (near + far) * dd_dh * dk_df;
  result.d_prime = d;
  result.standard_error = std::sqrt(dd_dh * dd_dh * h * (1.0 - h) / hits.trials +
                                    dd_df * dd_df * f * (1.0 - f) / false_alarms.trials);
  const double half = normal_quantile(0.5 + 0.5 * confidence) * result.standard_error;
  result.interval = {.lower = std::max(0.0, d - half), .upper = d + half};
  return result;
}

}  // namespace kerf::psychophysics
