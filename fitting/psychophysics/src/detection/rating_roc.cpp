#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <Eigen/Dense>
#include <boost/math/distributions/chi_squared.hpp>

#include <kerf/psychophysics/detection/rating_roc.h>

#include "checks.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

using std::numbers::sqrt2;
constexpr double largest_mean = 14.0;
constexpr double largest_log_deviation = 3.0;

int sum_of(const std::vector<int>& counts) { return std::accumulate(counts.begin(), counts.end(), 0); }

void require_ratings(const Ratings& ratings) {
  require(ratings.noise.size() == ratings.signal.size() && ratings.noise.size() >= 2,
          "ratings have two categories or more, as many for signal and noise");
  for (const auto* counts : {&ratings.noise, &ratings.signal}) {
    require(std::all_of(counts->begin(), counts->end(), [](int count) { return count >= 0; }) &&
                sum_of(*counts) > 0,
            "ratings need trials with the signal and without it");
  }
}

/// The categories that somebody named: the others tell nothing.
Ratings named(const Ratings& ratings) {
  Ratings result;
  for (std::size_t j = 0; j < ratings.noise.size(); ++j) {
    if (ratings.noise[j] + ratings.signal[j] == 0) continue;
    result.noise.push_back(ratings.noise[j]);
    result.signal.push_back(ratings.signal[j]);
  }
  return result;
}

/// Mean, ln(deviation), criteria.
using RatingParameters = Eigen::VectorXd;

/// The likelihood of ratings, with its slope and expected information; the deviation is free or 1.
class RatingLikelihood {
 public:
  RatingLikelihood(Ratings ratings, bool equal_variances)
      : ratings_(std::move(ratings)),
        free_(equal_variances ? 1 : 2),
        criteria_(static_cast<Eigen::Index>(ratings_.noise.size()) - 1) {}

  [[nodiscard]] Eigen::Index size() const { return free_ + criteria_; }
  [[nodiscard]] Eigen::Index free() const { return free_; }
  [[nodiscard]] double deviation(const RatingParameters& at) const {
    return free_ == 2 ? std::exp(at[1]) : 1.0;
  }

  /// From the rates of each criterion; the deviations from the line through their z.
  [[nodiscard]] RatingParameters start() const {
    const double noise = sum_of(ratings_.noise);
    const double signal = sum_of(ratings_.signal);
    RatingParameters at = RatingParameters::Zero(size());
    Eigen::VectorXd z_signal(criteria_);
    double below_noise = 0.5;
    double below_signal = 0.5;
    for (Eigen::Index j = 0; j < criteria_; ++j) {
      below_noise += ratings_.noise[static_cast<std::size_t>(j)];
      below_signal += ratings_.signal[static_cast<std::size_t>(j)];
      at[free_ + j] = normal_quantile(below_noise / (noise + 1.0));
      z_signal[j] = normal_quantile(below_signal / (signal + 1.0));
    }
    for (Eigen::Index j = 1; j < criteria_; ++j)
      at[free_ + j] = std::max(at[free_ + j], at[free_ + j - 1] + 1e-3);
    const auto criteria = at.tail(criteria_);
    at[0] = criteria.mean() - z_signal.mean();
    return at;
  }

  [[nodiscard]] bool is_ordered(const RatingParameters& at) const {
    for (Eigen::Index j = 1; j < criteria_; ++j) {
      if (!(at[free_ + j] > at[free_ + j - 1])) return false;
    }
    return std::abs(at[0]) < largest_mean && (free_ == 1 || std::abs(at[1]) < largest_log_deviation);
  }

  double evaluate(const RatingParameters& at, Eigen::VectorXd& slope, Eigen::MatrixXd& information) const {
    slope = Eigen::VectorXd::Zero(size());
    information = Eigen::MatrixXd::Zero(size(), size());
    double sum = 0.0;
    for (const bool is_signal : {false, true}) {
      const std::vector<int>& counts = is_signal ? ratings_.signal : ratings_.noise;
      const double trials = sum_of(counts);
      for (Eigen::Index j = 0; j <= criteria_; ++j) {
        Eigen::VectorXd change = Eigen::VectorXd::Zero(size());
        const double p = std::max(1e-300, probability(at, is_signal, j, change));
        const double count = counts[static_cast<std::size_t>(j)];
        if (count > 0.0) sum += count * std::log(p);
        slope += count / p * change;
        if (p > 1e-12) information += trials / p * change * change.transpose();
      }
    }
    return sum;
  }

 private:
  /// Of a category, and how it changes with each parameter.
  double probability(const RatingParameters& at, bool is_signal, Eigen::Index category,
                     Eigen::VectorXd& change) const {
    const double deviation = is_signal ? this->deviation(at) : 1.0;
    double above = 0.0;  // P(z) at the upper end less that at the lower one, by the tail that rounds less
    double below = 0.0;
    const auto add_end = [&](Eigen::Index end, double sign) {
      const double z = (at[free_ + end] - (is_signal ? at[0] : 0.0)) / deviation;
      const double density = sign * normal_density(z);
      below += sign * normal_probability(z);
      above -= sign * normal_probability(-z);
      change[free_ + end] += density / deviation;
      if (!is_signal) return;
      change[0] -= density / deviation;
      if (free_ == 2) change[1] -= density * z;
    };
    const bool is_last = category == criteria_;
    if (!is_last) add_end(category, 1.0);
    if (category > 0) add_end(category - 1, -1.0);
    if (is_last) return above;
    return category == 0 ? below : std::max(below, above);
  }

  Ratings ratings_;
  Eigen::Index free_;
  Eigen::Index criteria_;
};

double saturated(const Ratings& ratings) {
  double sum = 0.0;
  for (const auto* counts : {&ratings.noise, &ratings.signal}) {
    const double trials = sum_of(*counts);
    for (const int count : *counts) sum += count > 0 ? count * std::log(count / trials) : 0.0;
  }
  return sum;
}

}  // namespace

RocArea roc_area(const Ratings& ratings, double confidence) {
  require_ratings(ratings);
  require_probability(confidence, "the confidence");
  const double noise = sum_of(ratings.noise);
  const double signal = sum_of(ratings.signal);
  // Of each category the share of the other kind that lies on its right side.
  std::vector<double> noise_below;
  std::vector<double> signal_above;
  double below = 0.0;
  double above = signal;
  double area = 0.0;
  for (std::size_t j = 0; j < ratings.noise.size(); ++j) {
    noise_below.push_back((below + 0.5 * ratings.noise[j]) / noise);
    signal_above.push_back((above - 0.5 * ratings.signal[j]) / signal);
    below += ratings.noise[j];
    above -= ratings.signal[j];
    area += ratings.signal[j] * noise_below.back() / signal;
  }
  double of_signal = 0.0;
  double of_noise = 0.0;
  for (std::size_t j = 0; j < ratings.noise.size(); ++j) {
    of_signal += ratings.signal[j] * std::pow(noise_below[j] - area, 2);
    of_noise += ratings.noise[j] * std::pow(signal_above[j] - area, 2);
  }
  const auto variance_of_mean = [](double squares, double n) {
    return n > 1.0 ? squares / (n - 1.0) / n : infinite;
  };
  RocArea result{
      .value = area,
      .standard_error = std::sqrt(variance_of_mean(of_signal, signal) + variance_of_mean(of_noise, noise))};
  if (result.standard_error <= 0.0 || !std::isfinite(result.standard_error)) return result;
  const double logit = std::log(area / (1.0 - area));
  const double half = normal_quantile(0.5 + 0.5 * confidence) * result.standard_error / (area * (1.0 - area));
  result.interval = {.lower = 1.0 / (1.0 + std::exp(half - logit)),
                     .upper = 1.0 / (1.0 + std::exp(-half - logit))};
  return result;
}

NormalRoc fit_normal_roc(const Ratings& ratings, bool equal_variances, double confidence) {
  require_ratings(ratings);
  require_probability(confidence, "the confidence");
  const Ratings used = named(ratings);
  const std::size_t least = equal_variances ? 2 : 3;
  require(used.noise.size() >= least, "the ratings name " + std::to_string(used.noise.size()) +
                                          " categories; such a curve needs " + std::to_string(least));
  const RatingLikelihood likelihood(used, equal_variances);
  RatingParameters at = likelihood.start();
  Eigen::VectorXd slope;
  Eigen::MatrixXd information;
  require(likelihood.is_ordered(at), "the ratings are those of no finite curve");
  double value = likelihood.evaluate(at, slope, information);
  bool is_found = false;
  for (int round = 0; round < 300 && !is_found; ++round) {
    const Eigen::VectorXd step = information.ldlt().solve(slope);
    const double promised = slope.dot(step);
    is_found = promised < 1e-12;
    double part = 1.0;
    for (; part > 1e-6 && !is_found; part *= 0.5) {
      const RatingParameters trial = at + part * step;
      if (!likelihood.is_ordered(trial)) continue;
      Eigen::VectorXd next_slope;
      Eigen::MatrixXd next_information;
      const double next = likelihood.evaluate(trial, next_slope, next_information);
      if (!(next >= value)) continue;
      at = trial;
      value = next;
      slope = next_slope;
      information = next_information;
      break;
    }
    if (part <= 1e-6) break;
  }
  require(
      is_found,
      "no finite curve fits the ratings best: signal and noise overlap too little, or in too few categories");
  const Eigen::MatrixXd covariance =
      information.ldlt().solve(Eigen::MatrixXd::Identity(at.size(), at.size()));
  const double deviation = likelihood.deviation(at);
  const double size = std::sqrt(0.5 * (1.0 + deviation * deviation));
  NormalRoc result{
      .mean = at[0],
      .deviation = deviation,
      .mean_error = std::sqrt(covariance(0, 0)),
      .log_deviation_error = equal_variances ? 0.0 : std::sqrt(covariance(1, 1)),
      .criteria = {at.data() + likelihood.free(), at.data() + at.size()},
      .d_a = at[0] / size,
      .area = normal_probability(at[0] / size / sqrt2),
      .log_likelihood = value,
      .deviance = std::max(0.0, 2.0 * (saturated(used) - value)),
      .degrees_of_freedom = static_cast<int>(2 * (used.noise.size() - 1)) - static_cast<int>(at.size())};
  Eigen::VectorXd change = Eigen::VectorXd::Zero(at.size());
  change[0] = 1.0 / size;
  if (!equal_variances) change[1] = -0.5 * at[0] * deviation * deviation / (size * size * size);
  result.d_a_error = std::sqrt(change.dot(covariance * change));
  require(std::isfinite(result.d_a_error) && result.d_a_error < 10.0,
          "the ratings do not close the curve: signal and noise overlap too little");
  const double half = normal_quantile(0.5 + 0.5 * confidence) * result.d_a_error;
  result.d_a_interval = {.lower = result.d_a - half, .upper = result.d_a + half};
  return result;
}

double equal_variances_p(const NormalRoc& free, const NormalRoc& equal) {
  const double ratio = std::max(0.0, 2.0 * (free.log_likelihood - equal.log_likelihood));
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(1.0), ratio));
}

}  // namespace kerf::psychophysics
