#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <boost/math/quadrature/gauss.hpp>

#include <kerf/psychophysics/posterior.h>

#include "checks.h"
#include "psychometric/support.h"

namespace kerf::psychophysics {
namespace {

constexpr std::size_t threshold_count = 101;
constexpr unsigned slope_count = 15;
constexpr unsigned lapse_count = 7;
constexpr double least_slope = 0.5;
constexpr double largest_slope = 10.0;
constexpr double beyond = 10.0;            ///< how far the thresholds go past the levels
constexpr double at_the_end = 1.0 / 60.0;  ///< of the range of the thresholds

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

/// The answers of each level together: a staircase comes as a row a trial.
std::vector<Cell> cells_of(std::span<const Level> levels) {
  std::vector<Cell> rows;
  for (const Level& level : levels)
    rows.push_back({.at = std::log(level.intensity), .answers = level.answers});
  std::ranges::sort(rows, {}, &Cell::at);
  std::vector<Cell> cells;
  for (const Cell& row : rows) {
    if (cells.empty() || cells.back().at != row.at) {
      cells.push_back(row);
      continue;
    }
    cells.back().answers.successes += row.answers.successes;
    cells.back().answers.trials += row.answers.trials;
  }
  return cells;
}

/// The likelihood, with the range of the prior as its bounds.
Problem problem_of(std::span<const Level> levels, const FitOptions& options) {
  Problem problem{.shape = options.shape,
                  .guess = options.guess,
                  .criterion = options.criterion.value_or(options.guess + 0.5 * (1.0 - options.guess)),
                  .cells = cells_of(levels)};
  const double first_lapse = options.lapse.value_or(0.0);
  require(problem.criterion > options.guess && problem.criterion < 1.0 - first_lapse,
          "the criterion lies beyond what the curve reaches");
  // Curves that do not reach the criterion have no threshold.
  const double last_lapse = std::min(options.lapse.value_or(options.largest_lapse),
                                     first_lapse + (1.0 - 1e-9) * (1.0 - problem.criterion - first_lapse));
  problem.lower = {problem.cells.front().at - std::log(beyond), std::log(least_slope), first_lapse, 0.0};
  problem.upper = {problem.cells.back().at + std::log(beyond), std::log(largest_slope), last_lapse, 0.0};
  return problem;
}

struct Node {
  double at = 0.0;
  double weight = 1.0;
};

/// Of Gauss and Legendre between two ends; one where they are the same.
template <unsigned count>
std::vector<Node> nodes_between(double lower, double upper) {
  using Rule = boost::math::quadrature::gauss<double, count>;
  if (lower == upper) return {{.at = lower, .weight = 1.0}};
  std::vector<Node> nodes;
  const double centre = 0.5 * (lower + upper);
  const double half = 0.5 * (upper - lower);
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    const double reach = half * Rule::abscissa()[i];
    nodes.push_back({.at = centre + reach, .weight = Rule::weights()[i]});
    if (reach > 0.0) nodes.push_back({.at = centre - reach, .weight = Rule::weights()[i]});
  }
  return nodes;
}

/// Density over ln(threshold) at equal steps, without its scale.
class Marginal {
 public:
  Marginal(const Problem& problem, const Support& support)
      : first_(support.lower[threshold_index]),
        step_((support.upper[threshold_index] - first_) / (threshold_count - 1.0)),
        density_(threshold_count, 0.0) {
    const auto slopes = nodes_between<slope_count>(support.lower[slope_index], support.upper[slope_index]);
    const auto lapses = nodes_between<lapse_count>(support.lower[lapse_index], support.upper[lapse_index]);
    for (std::size_t place = 0; place < threshold_count; ++place) {
      for (const Node& slope : slopes) {
        for (const Node& lapse : lapses) {
          const double log = log_likelihood(problem, {at(place), slope.at, lapse.at, 0.0});
          density_[place] += slope.weight * lapse.weight * std::exp(log - support.largest);
        }
      }
    }
    for (std::size_t cell = 0; cell + 1 < threshold_count; ++cell) mass_.push_back(mass_of(cell));
    for (const double mass : mass_) total_ += mass;
  }

  [[nodiscard]] double quantile(double share) const {
    double missing = share * total_;
    std::size_t cell = 0;
    for (; cell + 1 < mass_.size() && mass_[cell] < missing; ++cell) missing -= mass_[cell];
    if (!(mass_[cell] > 0.0)) return at(cell);
    // Within a cell the density is a line.
    const double part = missing / mass_[cell];
    const double rise = density_[cell + 1] - density_[cell];
    const double mean = 0.5 * (density_[cell + 1] + density_[cell]);
    const double root = std::sqrt(density_[cell] * density_[cell] + 2.0 * rise * part * mean);
    return at(cell) + step_ * 2.0 * part * mean / (density_[cell] + root);
  }

 private:
  [[nodiscard]] double at(std::size_t place) const { return first_ + step_ * static_cast<double>(place); }

  /// Integral from one place to the next, of the cubic through four [steps].
  [[nodiscard]] double mass_of(std::size_t cell) const {
    const auto f = [&](std::size_t place) { return density_[place]; };
    constexpr std::size_t last = threshold_count - 1;
    double mass = 0.0;
    if (cell == 0)
      mass = 9.0 * f(0) + 19.0 * f(1) - 5.0 * f(2) + f(3);
    else if (cell + 1 == last)
      mass = 9.0 * f(last) + 19.0 * f(last - 1) - 5.0 * f(last - 2) + f(last - 3);
    else
      mass = 13.0 * (f(cell) + f(cell + 1)) - f(cell - 1) - f(cell + 2);
    return std::max(0.0, mass / 24.0);
  }

  double first_;
  double step_;
  std::vector<double> density_;
  std::vector<double> mass_;
  double total_ = 0.0;
};

}  // namespace

Threshold posterior_threshold(std::span<const Level> levels, const FitOptions& options) {
  require_question(levels, options);
  const Problem problem = problem_of(levels, options);
  const Marginal marginal(problem, support_of(problem, {false, false, options.lapse.has_value(), true}));
  const double tail = 0.5 * (1.0 - options.confidence);
  const double lower = marginal.quantile(tail);
  const double upper = marginal.quantile(1.0 - tail);
  // There it is the prior that ends the interval, and not the answers.
  const double first = problem.lower[threshold_index];
  const double last = problem.upper[threshold_index];
  const bool open_below = lower < first + at_the_end * (last - first);
  const bool open_above = upper > last - at_the_end * (last - first);
  return {.value = std::exp(marginal.quantile(0.5)),
          .criterion = problem.criterion,
          .interval = {.lower = open_below ? 0.0 : std::exp(lower),
                       .upper = open_above ? std::numeric_limits<double>::infinity() : std::exp(upper)}};
}

}  // namespace kerf::psychophysics
