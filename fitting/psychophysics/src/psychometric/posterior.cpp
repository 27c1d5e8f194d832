#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <kerf/psychophysics/posterior.h>

#include "checks.h"
#include "psychometric/shape.h"

namespace kerf::psychophysics {
namespace {

constexpr std::size_t threshold_count = 121;
constexpr std::size_t slope_count = 15;
constexpr std::size_t lapse_count = 4;
constexpr double least_slope = 0.5;
constexpr double largest_slope = 10.0;
constexpr double beyond = 10.0;  ///< how far the thresholds go past the levels

void require_question(std::span<const Level> levels, const FitOptions& options) {
  require(!levels.empty(), "there are no answers: a threshold needs some");
  require(options.axis == Axis::logarithmic && !options.overdispersed,
          "a posterior is for a logarithmic axis and the answers of one subject");
  require(options.guess >= 0.0 && options.guess < 1.0, "the guess rate must lie in 0 to 1");
  require_probability(options.confidence, "the confidence");
  for (const Level& level : levels) {
    require(level.answers);
    require(level.intensity > 0.0 && std::isfinite(level.intensity),
            "a level is " + std::to_string(level.intensity) + "; a posterior takes levels above 0");
  }
}

std::vector<double> lapses_of(const FitOptions& options) {
  if (options.lapse) return {*options.lapse};
  std::vector<double> rates;
  for (std::size_t i = 0; i < lapse_count; ++i)
    rates.push_back(options.largest_lapse * static_cast<double>(i) / (lapse_count - 1.0));
  return rates;
}

/// Steps of equal size on the axis of ln(threshold), with what they weigh.
struct Marginal {
  double first = 0.0;
  double step = 0.0;
  std::vector<double> weights = std::vector<double>(threshold_count, 0.0);

  [[nodiscard]] double at(std::size_t place) const { return first + step * static_cast<double>(place); }

  /// Every grid point stands for the step about it.
  [[nodiscard]] double quantile(double share) const {
    double below = 0.0;
    for (std::size_t place = 0; place < threshold_count; ++place) {
      if (below + weights[place] >= share && weights[place] > 0.0)
        return at(place) + step * ((share - below) / weights[place] - 0.5);
      below += weights[place];
    }
    return at(threshold_count - 1) + 0.5 * step;
  }
};

/// log-likelihood of a curve whose criterion lies `shift` above its own threshold on the axis.
struct CurveOnAxis {
  double slope = 1.0;
  double lapse = 0.0;
  double shift = 0.0;
};

double log_likelihood(const std::vector<std::array<double, 3>>& rows, const CurveOnAxis& curve,
                      double criterion_at, const FitOptions& options) {
  constexpr double tiny = 1e-12;
  double sum = 0.0;
  for (const auto& [at, right, wrong] : rows) {
    const double share = shape_at(options.shape, curve.slope * (at - criterion_at + curve.shift)).below;
    const double psi = options.guess + (1.0 - options.guess - curve.lapse) * share;
    if (right > 0.0) sum += right * std::log(std::max(psi, tiny));
    if (wrong > 0.0) sum += wrong * std::log(std::max(1.0 - psi, tiny));
  }
  return sum;
}

Marginal marginal_of(const std::vector<std::array<double, 3>>& rows, double criterion,
                     const FitOptions& options) {
  const auto [least, most] =
      std::minmax_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  Marginal marginal{.first = (*least)[0] - std::log(beyond)};
  marginal.step = ((*most)[0] + std::log(beyond) - marginal.first) / (threshold_count - 1.0);
  std::vector<std::vector<double>> logs(threshold_count);
  double largest = -std::numeric_limits<double>::infinity();
  for (const double lapse : lapses_of(options)) {
    if (criterion <= options.guess || criterion >= 1.0 - lapse) continue;  // no such curve reaches it
    const double share = (criterion - options.guess) / (1.0 - options.guess - lapse);
    for (std::size_t i = 0; i < slope_count; ++i) {
      CurveOnAxis curve{.lapse = lapse};
      curve.slope =
          least_slope * std::pow(largest_slope / least_slope, static_cast<double>(i) / (slope_count - 1.0));
      curve.shift = shape_quantile(options.shape, share) / curve.slope;
      for (std::size_t place = 0; place < threshold_count; ++place) {
        logs[place].push_back(log_likelihood(rows, curve, marginal.at(place), options));
        largest = std::max(largest, logs[place].back());
      }
    }
  }
  require(std::isfinite(largest), "the criterion lies beyond what the curve reaches");
  double total = 0.0;
  for (std::size_t place = 0; place < threshold_count; ++place) {
    for (const double log : logs[place]) marginal.weights[place] += std::exp(log - largest);
    total += marginal.weights[place];
  }
  for (double& weight : marginal.weights) weight /= total;
  return marginal;
}

}  // namespace

Threshold posterior_threshold(std::span<const Level> levels, const FitOptions& options) {
  require_question(levels, options);
  std::vector<std::array<double, 3>> rows;
  for (const Level& level : levels)
    rows.push_back({std::log(level.intensity), static_cast<double>(level.answers.successes),
                    static_cast<double>(level.answers.trials - level.answers.successes)});
  const double criterion = options.criterion.value_or(options.guess + 0.5 * (1.0 - options.guess));
  const Marginal marginal = marginal_of(rows, criterion, options);
  const double tail = 0.5 * (1.0 - options.confidence);
  const double lower = marginal.quantile(tail);
  const double upper = marginal.quantile(1.0 - tail);
  // Within two steps of its end it is the grid that ends the interval, and not the answers.
  const bool open_below = lower < marginal.at(2);
  const bool open_above = upper > marginal.at(threshold_count - 3);
  return {.value = std::exp(marginal.quantile(0.5)),
          .criterion = criterion,
          .interval = {.lower = open_below ? 0.0 : std::exp(lower),
                       .upper = open_above ? std::numeric_limits<double>::infinity() : std::exp(upper)}};
}

}  // namespace kerf::psychophysics
