#include "ranking.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>

#include <kerf/psychophysics/comparisons.h>

#include "checks.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

struct Link {
  double probability = 0.5;
  double density = 0.25;  ///< dP / d(difference of worth)
};

Link link(Scale scale, double difference) {
  if (scale == Scale::bradley_terry) {
    const double p = 1.0 / (1.0 + std::exp(-difference));
    return {.probability = p, .density = p / (1.0 + std::exp(difference))};
  }
  const double z = difference / std::numbers::sqrt2;
  return {.probability = normal_probability(z), .density = normal_density(z) / std::numbers::sqrt2};
}

double log_likelihood(const Wins& wins, Scale scale, const std::vector<double>& worth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < wins.size(); ++i) {
    for (std::size_t j = 0; j < wins.size(); ++j) {
      if (i == j || wins[i][j] == 0) continue;
      sum += wins[i][j] * std::log(std::max(1e-300, link(scale, worth[i] - worth[j]).probability));
    }
  }
  return sum;
}

/// From one item every other must be reached along wins, and along losses.
bool reaches_all(const Wins& wins, bool along_wins) {
  std::vector<bool> seen(wins.size(), false);
  std::vector<std::size_t> open{0};
  seen[0] = true;
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    for (std::size_t j = 0; j < wins.size(); ++j) {
      if (seen[j] || i == j || (along_wins ? wins[i][j] : wins[j][i]) == 0) continue;
      seen[j] = true;
      open.push_back(j);
    }
  }
  return std::all_of(seen.begin(), seen.end(), [](bool is_seen) { return is_seen; });
}

void require_rankable(const Wins& wins) {
  require(wins.size() >= 2 && wins.size() <= 50, "a ranking needs 2 to 50 items");
  for (const auto& row : wins) {
    require(row.size() == wins.size(), "wins must be a square table: one row and one column an item");
    require(std::all_of(row.begin(), row.end(), [](int count) { return count >= 0; }),
            "a count of wins is below zero");
  }
  require(reaches_all(wins, true) && reaches_all(wins, false),
          "some items never won, or never lost, against all the others: their worth has no finite estimate, "
          "so compare "
          "them by the binomial test, or gather more answers");
}

}  // namespace

Matrix inverse(Matrix a) {
  const std::size_t n = a.size();
  Matrix b(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) b[i][i] = 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = a[k][k];
    for (std::size_t j = 0; j < n; ++j) {
      a[k][j] /= pivot;
      b[k][j] /= pivot;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k];
      for (std::size_t j = 0; j < n; ++j) {
        a[i][j] -= factor * a[k][j];
        b[i][j] -= factor * b[k][j];
      }
    }
  }
  return b;
}

RankingDerivatives derivatives(const Wins& wins, Scale scale, const std::vector<double>& worth) {
  const std::size_t n = wins.size();
  RankingDerivatives d{.gradient = std::vector<double>(n, 0.0),
                       .information = Matrix(n, std::vector<double>(n, 0.0))};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const double trials = wins[i][j] + wins[j][i];
      if (trials == 0.0) continue;
      const Link at = link(scale, worth[i] - worth[j]);
      const double variance = std::max(1e-300, at.probability * (1.0 - at.probability));
      const double gradient = (wins[i][j] - trials * at.probability) * at.density / variance;
      const double weight = trials * at.density * at.density / variance;
      d.gradient[i] += gradient;
      d.gradient[j] -= gradient;
      d.information[i][i] += weight;
      d.information[j][j] += weight;
      d.information[i][j] -= weight;
      d.information[j][i] -= weight;
    }
  }
  return d;
}

Matrix covariance_of(Matrix information) {
  const auto share = 1.0 / static_cast<double>(information.size());
  for (auto& row : information) {
    for (double& value : row) value += share;
  }
  Matrix covariance = inverse(std::move(information));
  for (auto& row : covariance) {
    for (double& value : row) value -= share;
  }
  return covariance;
}

namespace {

void maximise(const Wins& wins, Scale scale, std::vector<double>& worth) {
  const std::size_t n = wins.size();
  double now = log_likelihood(wins, scale, worth);
  for (int round = 0; round < 200; ++round) {
    const RankingDerivatives d = derivatives(wins, scale, worth);
    const Matrix covariance = covariance_of(d.information);
    std::vector<double> step(n, 0.0);
    double largest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) step[i] += covariance[i][j] * d.gradient[j];
      largest = std::max(largest, std::abs(step[i]));
    }
    if (largest < 1e-12) return;
    double part = 1.0;
    std::vector<double> next(n);
    for (int halving = 0; halving < 40; ++halving) {
      for (std::size_t i = 0; i < n; ++i) next[i] = worth[i] + part * step[i];
      const double there = log_likelihood(wins, scale, next);
      if (there >= now - 1e-12 * std::abs(now)) {
        now = there;
        worth = next;
        break;
      }
      part *= 0.5;
    }
  }
}

double upper_tail(double statistic, int degrees_of_freedom) {
  if (degrees_of_freedom <= 0) return 1.0;
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(degrees_of_freedom), std::max(0.0, statistic)));
}

}  // namespace

Ranking rank(const Wins& wins, Scale scale) {
  require_rankable(wins);
  const std::size_t n = wins.size();
  Ranking result;
  result.scale = scale;
  result.worth.assign(n, 0.0);
  const double equal = log_likelihood(wins, scale, result.worth);
  maximise(wins, scale, result.worth);
  result.log_likelihood = log_likelihood(wins, scale, result.worth);
  result.covariance = covariance_of(derivatives(wins, scale, result.worth).information);
  double saturated = 0.0;
  int pairs = 0;
  for (std::size_t i = 0; i < n; ++i) {
    result.standard_error.push_back(std::sqrt(result.covariance[i][i]));
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const double trials = wins[i][j] + wins[j][i];
      if (wins[i][j] > 0) saturated += wins[i][j] * std::log(wins[i][j] / trials);
      pairs += i < j && trials > 0.0 ? 1 : 0;
    }
  }
  result.ratio = std::max(0.0, 2.0 * (result.log_likelihood - equal));
  result.ratio_degrees_of_freedom = static_cast<int>(n) - 1;
  result.ratio_p = upper_tail(result.ratio, result.ratio_degrees_of_freedom);
  result.deviance = std::max(0.0, 2.0 * (saturated - result.log_likelihood));
  result.deviance_degrees_of_freedom = pairs - result.ratio_degrees_of_freedom;
  result.deviance_p = upper_tail(result.deviance, result.deviance_degrees_of_freedom);
  return result;
}

Difference difference(const Ranking& ranking, std::size_t first, std::size_t second) {
  require(first < ranking.worth.size() && second < ranking.worth.size() && first != second,
          "a difference is between two items of the ranking");
  const auto& c = ranking.covariance;
  const double value = ranking.worth[first] - ranking.worth[second];
  const double error = std::sqrt(c[first][first] + c[second][second] - 2.0 * c[first][second]);
  return {.value = value, .standard_error = error, .p = 2.0 * normal_probability(-std::abs(value) / error)};
}

}  // namespace kerf::psychophysics
