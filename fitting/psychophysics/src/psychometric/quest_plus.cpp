#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include <kerf/psychophysics/quest_plus.h>

#include "checks.h"

namespace kerf::psychophysics {
namespace {

constexpr std::size_t largest_table = 20'000'000;

void require_grid(const std::vector<double>& grid, const char* name) {
  require(!grid.empty() &&
              std::adjacent_find(grid.begin(), grid.end(), std::greater_equal<>()) == grid.end() &&
              std::isfinite(grid.front()) && std::isfinite(grid.back()),
          std::string("the grid of ") + name + " must ascend and hold one finite number at least");
}

/// Of weights that are not yet divided by their sum: H = ln s - (sum w ln w) / s.
struct Entropy {
  double sum = 0.0;
  double w_log_w = 0.0;

  void add(double weight) {
    if (weight <= 0.0) return;
    sum += weight;
    w_log_w += weight * std::log(weight);
  }
  [[nodiscard]] double times_sum() const { return sum > 0.0 ? sum * std::log(sum) - w_log_w : 0.0; }
};

}  // namespace

std::vector<double> geometric_grid(double first, double last, std::size_t count) {
  require(first > 0.0 && last > first && count >= 2,
          "a geometric grid needs 0 < first < last and two points");
  std::vector<double> grid(count);
  for (std::size_t i = 0; i < count; ++i)
    grid[i] = first * std::pow(last / first, static_cast<double>(i) / static_cast<double>(count - 1));
  return grid;
}

QuestPlus::QuestPlus(QuestPlusOptions options) : options_(std::move(options)) {
  require_grid(options_.intensities, "intensities");
  require_grid(options_.thresholds, "thresholds");
  require_grid(options_.slopes, "slopes");
  require_grid(options_.lapses, "lapse rates");
  if (options_.guesses.empty()) options_.guesses = {options_.guess};
  require_grid(options_.guesses, "guess rates");
  require(options_.trials > 0, "QUEST+ needs trials");
  require(options_.narrow >= 0.0 && std::isfinite(options_.narrow),
          "the width of an interval at which QUEST+ ends must be finite and not below zero");
  require_probability(options_.narrow_confidence, "the confidence");
  const std::size_t rest = points_beside_thresholds();
  const std::size_t points = options_.thresholds.size() * rest;
  require(points <= largest_table / options_.intensities.size(),
          "the grids of QUEST+ are too fine: intensities x thresholds x slopes x guess rates x lapse rates "
          "may be "
          "20 million");
  auto& prior = options_.weights_of_thresholds;
  if (prior.empty()) prior.assign(options_.thresholds.size(), 1.0);
  double sum = 0.0;
  for (const double weight : prior) {
    require(weight >= 0.0 && std::isfinite(weight), "a prior weight must be finite and not below zero");
    sum += weight;
  }
  require(prior.size() == options_.thresholds.size() && sum > 0.0,
          "the prior needs one weight a threshold, not all zero");
  weights_.reserve(points);
  right_.reserve(points * options_.intensities.size());
  for (const double weight : prior)
    weights_.insert(weights_.end(), rest, weight / sum / static_cast<double>(rest));
  for (const double intensity : options_.intensities) {
    Psychometric curve{.shape = options_.shape, .axis = options_.axis, .guess = options_.guess};
    for (const double threshold : options_.thresholds) {
      for (const double slope : options_.slopes) {
        for (const double guess : options_.guesses) {
          for (const double lapse : options_.lapses) {
            curve.threshold = threshold;
            curve.slope = slope;
            curve.guess = guess;
            curve.lapse = lapse;
            right_.push_back(curve.probability(intensity));
          }
        }
      }
    }
  }
  if (options_.nuisance.any()) set_interest();
  choose();
}

std::size_t QuestPlus::points_beside_thresholds() const {
  return options_.slopes.size() * options_.guesses.size() * options_.lapses.size();
}

void QuestPlus::set_interest() {
  const Nuisance& nuisance = options_.nuisance;
  const std::size_t slopes = nuisance.slope ? 1 : options_.slopes.size();
  const std::size_t guesses = nuisance.guess ? 1 : options_.guesses.size();
  const std::size_t lapses = nuisance.lapse ? 1 : options_.lapses.size();
  interest_.reserve(weights_.size());
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    std::size_t rest = i;
    const std::size_t lapse = rest % options_.lapses.size();
    rest /= options_.lapses.size();
    const std::size_t guess = rest % options_.guesses.size();
    rest /= options_.guesses.size();
    const std::size_t slope = rest % options_.slopes.size();
    const std::size_t threshold = rest / options_.slopes.size();
    interest_.push_back(((threshold * slopes + slope % slopes) * guesses + guess % guesses) * lapses +
                        lapse % lapses);
  }
}

void QuestPlus::answer(bool is_right) {
  require(!finished(), "QUEST+ has ended and takes no further answers");
  update(next_, is_right);
}

void QuestPlus::answer(double intensity, bool is_right) {
  require(!finished(), "QUEST+ has ended and takes no further answers");
  const auto found = std::find(options_.intensities.begin(), options_.intensities.end(), intensity);
  require(found != options_.intensities.end(), "the intensity is not one of the grid");
  update(static_cast<std::size_t>(found - options_.intensities.begin()), is_right);
}

void QuestPlus::update(std::size_t intensity, bool is_right) {
  const double* right = &right_[intensity * weights_.size()];
  std::vector<double> next(weights_.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    next[i] = weights_[i] * (is_right ? right[i] : 1.0 - right[i]);
    sum += next[i];
  }
  require(sum > 0.0, "no curve of the grid can give this answer: allow a lapse rate above zero");
  for (double& weight : next) weight /= sum;
  weights_ = std::move(next);
  ++trials_;
  choose();
}

void QuestPlus::choose() {
  double least = HUGE_VAL;
  for (std::size_t x = 0; x < options_.intensities.size(); ++x) {
    const double expected = interest_.empty() ? expected_entropy(x) : expected_entropy_of_interest(x);
    // What differs in the last digits alone is the same, whatever the machine's logarithm does with them.
    if (expected < least - 1e-10) {
      least = expected;
      next_ = x;
    }
  }
}

double QuestPlus::expected_entropy(std::size_t intensity) const {
  const double* right = &right_[intensity * weights_.size()];
  Entropy if_right;
  Entropy if_wrong;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    if_right.add(weights_[i] * right[i]);
    if_wrong.add(weights_[i] * (1.0 - right[i]));
  }
  return if_right.times_sum() + if_wrong.times_sum();
}

double QuestPlus::expected_entropy_of_interest(std::size_t intensity) const {
  const double* right = &right_[intensity * weights_.size()];
  std::vector<double> sums_if_right(interest_.back() + 1, 0.0);
  std::vector<double> sums_if_wrong(interest_.back() + 1, 0.0);
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    sums_if_right[interest_[i]] += weights_[i] * right[i];
    sums_if_wrong[interest_[i]] += weights_[i] * (1.0 - right[i]);
  }
  Entropy if_right;
  Entropy if_wrong;
  for (const double sum : sums_if_right) if_right.add(sum);
  for (const double sum : sums_if_wrong) if_wrong.add(sum);
  return if_right.times_sum() + if_wrong.times_sum();
}

bool QuestPlus::finished() const {
  if (trials_ >= options_.trials) return true;
  if (trials_ < std::max(1, options_.least_trials)) return false;
  if (options_.small_deviation > 0.0 && estimate().deviation < options_.small_deviation) return true;
  if (options_.narrow == 0.0) return false;
  const Interval interval = estimate(options_.narrow_confidence).interval;
  const double width =
      options_.axis == Axis::logarithmic ? interval.upper / interval.lower : interval.upper - interval.lower;
  return width <= options_.narrow;
}

std::vector<double> QuestPlus::marginal() const {
  const std::size_t rest = points_beside_thresholds();
  std::vector<double> sums(options_.thresholds.size(), 0.0);
  for (std::size_t i = 0; i < weights_.size(); ++i) sums[i / rest] += weights_[i];
  return sums;
}

QuestPlusEstimate QuestPlus::estimate(double confidence) const {
  require_probability(confidence, "the confidence");
  const bool is_logarithmic = options_.axis == Axis::logarithmic;
  const auto on_axis = [&](double value) { return is_logarithmic ? std::log(value) : value; };
  const auto off_axis = [&](double value) { return is_logarithmic ? std::exp(value) : value; };
  const std::vector<double> weights = marginal();
  double mean = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) mean += weights[i] * on_axis(options_.thresholds[i]);
  double variance = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    variance += weights[i] * std::pow(on_axis(options_.thresholds[i]) - mean, 2);
  // The weight of a grid point is spread around it: the distribution at the point holds half of it.
  const auto quantile = [&](double share) {
    double below = 0.0;
    double last_at = on_axis(options_.thresholds[0]);
    double last_share = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double at = on_axis(options_.thresholds[i]);
      const double here = below + 0.5 * weights[i];
      if (here >= share) {
        const double part = here > last_share ? (share - last_share) / (here - last_share) : 1.0;
        return last_at + part * (at - last_at);
      }
      below += weights[i];
      last_at = at;
      last_share = here;
    }
    return on_axis(options_.thresholds.back());
  };
  QuestPlusEstimate result{.threshold = off_axis(mean),
                           .deviation = std::sqrt(variance),
                           .interval = {.lower = off_axis(quantile(0.5 - 0.5 * confidence)),
                                        .upper = off_axis(quantile(0.5 + 0.5 * confidence))}};
  double log_slope = 0.0;
  const std::size_t lapses = options_.lapses.size();
  const std::size_t guesses = options_.guesses.size();
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    log_slope += weights_[i] * std::log(options_.slopes[i / (lapses * guesses) % options_.slopes.size()]);
    result.guess += weights_[i] * options_.guesses[i / lapses % guesses];
    result.lapse += weights_[i] * options_.lapses[i % lapses];
  }
  result.slope = std::exp(log_slope);
  return result;
}

}  // namespace kerf::psychophysics
