#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <kerf/psychophysics/repeated_measures.h>

#include "checks.h"

namespace kerf::psychophysics {
namespace {

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

bool are_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// Of one subject, from 1 for the lowest; adds t^3 - t of every tie.
std::vector<double> ranks_of(const std::vector<double>& values, double& ties) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t at) { return values[at]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = 0.5 * (static_cast<double>(i + end) + 1.0);
    const auto tied = static_cast<double>(end - i);
    ties += tied * tied * tied - tied;
    i = end;
  }
  return ranks;
}

}  // namespace

double SubjectsMean::p_of(double hypothesis) const {
  if (standard_error == 0.0) return mean == hypothesis ? 1.0 : 0.0;
  const double t = std::abs(mean - hypothesis) / standard_error;
  return 2.0 * boost::math::cdf(boost::math::complement(boost::math::students_t(degrees_of_freedom), t));
}

SubjectsMean subjects_mean(std::span<const double> values, double confidence) {
  require(values.size() >= 2, "a mean over subjects with its interval needs two subjects at least");
  require(are_finite(values), "a value of a subject is no finite number");
  require_probability(confidence, "the confidence");
  const auto n = static_cast<double>(values.size());
  SubjectsMean result{.mean = mean_of(values), .degrees_of_freedom = n - 1.0, .interval = {}};
  double squares = 0.0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.standard_error = std::sqrt(squares / (n - 1.0) / n);
  const double reach =
      result.standard_error *
      boost::math::quantile(boost::math::students_t(result.degrees_of_freedom), 0.5 + 0.5 * confidence);
  result.interval = {.lower = result.mean - reach, .upper = result.mean + reach};
  return result;
}

FriedmanTest friedman_test(const std::vector<std::vector<double>>& rows) {
  require(rows.size() >= 2, "Friedman's test needs two subjects at least");
  const std::size_t samples = rows.front().size();
  require(samples >= 2, "Friedman's test needs two samples at least");
  double ties = 0.0;
  FriedmanTest result{.degrees_of_freedom = static_cast<int>(samples) - 1,
                      .mean_ranks = std::vector<double>(samples)};
  const auto n = static_cast<double>(rows.size());
  const auto k = static_cast<double>(samples);
  for (const std::vector<double>& row : rows) {
    require(row.size() == samples, "Friedman's test needs the same samples of every subject");
    require(are_finite(row), "a value of a subject is no finite number");
    const std::vector<double> ranks = ranks_of(row, ties);
    for (std::size_t j = 0; j < samples; ++j) result.mean_ranks[j] += ranks[j] / n;
  }
  double squares = 0.0;
  for (const double rank : result.mean_ranks) squares += std::pow(n * (rank - 0.5 * (k + 1.0)), 2);
  const double spread = n * k * (k + 1.0) - ties / (k - 1.0);
  if (spread <= 0.0) return result;
  result.statistic = 12.0 * squares / spread;
  result.agreement = result.statistic / (n * (k - 1.0));
  result.p = boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(result.degrees_of_freedom), result.statistic));
  return result;
}

double slope_of_line(std::span<const double> x, std::span<const double> y) {
  require(x.size() == y.size(), "a line needs as many x as y");
  require(x.size() >= 2, "a line needs two points at least");
  require(are_finite(x) && are_finite(y), "a point of a line is no finite number");
  const double x_mean = mean_of(x);
  const double y_mean = mean_of(y);
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    squares += (x[i] - x_mean) * (x[i] - x_mean);
    products += (x[i] - x_mean) * (y[i] - y_mean);
  }
  require(squares > 0.0, "a line through points of the same x has no slope");
  return products / squares;
}

}  // namespace kerf::psychophysics
