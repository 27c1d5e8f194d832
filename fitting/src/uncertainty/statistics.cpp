#include "uncertainty/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <unsupported/Eigen/FFT>

namespace kerf::fitting {
namespace {

constexpr double window = 5.0;

/// Sums of products at every lag, by the transform of the zero-padded values.
std::vector<double> autocovariance(std::vector<double> values) {
  const std::size_t padded = std::bit_ceil(2 * values.size());
  values.resize(padded, 0.0);
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, values);
  for (auto& component : spectrum) component = std::norm(component);
  transform.inv(values, spectrum);
  return values;
}

struct Counted {
  std::size_t below = 0, between = 0;
};
/// Brings the values from `low` to `high` to the front, without a branch, which chance would decide.
Counted bring_to_front(std::vector<double>& values, double low, double high) {
  Counted found;
  for (double& place : values) {
    const double value = place;
    place = std::exchange(values[found.between], value);
    found.between += static_cast<std::size_t>(value >= low) & static_cast<std::size_t>(value <= high);
    found.below += static_cast<std::size_t>(value < low);
  }
  return found;
}

/// The median of very many values, looked for between two quantiles of some of them. Nothing where it lies
/// elsewhere: of a few series in a million, and of those that repeat themselves where they are looked at.
std::optional<double> median_of_many(std::vector<double>& values) {
  constexpr std::size_t looked_at = 2048;
  constexpr std::size_t margin = 113;  // five deviations of the place of a median among so many
  std::vector<double> some(looked_at);
  for (std::size_t i = 0; i < looked_at; ++i) some[i] = values[i * values.size() / looked_at];
  const auto low = some.begin() + (looked_at / 2 - margin);
  const auto high = some.begin() + (looked_at / 2 + margin);
  std::nth_element(some.begin(), low, some.end());
  std::nth_element(low + 1, high, some.end());
  const Counted found = bring_to_front(values, *low, *high);
  const std::size_t first = (values.size() - 1) / 2;  // of the two in the middle, or the one
  const std::size_t last = values.size() / 2;
  if (first < found.below || last >= found.below + found.between) return std::nullopt;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(first - found.below);
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(found.between);
  std::nth_element(values.begin(), at, end);
  return first == last ? *at : std::midpoint(*at, *std::min_element(at + 1, end));
}

}  // namespace

double correlation_time(const std::vector<double>& residuals) {
  const std::size_t count = residuals.size();
  const double mean = std::accumulate(residuals.begin(), residuals.end(), 0.0) / static_cast<double>(count);
  std::vector<double> centred;
  for (const double r : residuals) centred.push_back(r - mean);
  const double variance = std::inner_product(centred.begin(), centred.end(), centred.begin(), 0.0);
  if (!(variance > 0.0)) return 1.0;
  const std::vector<double> covariance = autocovariance(std::move(centred));
  double time = 1.0;
  for (std::size_t lag = 1; lag < count / 2; ++lag) {
    time += 2.0 * covariance[lag] / covariance[0];
    if (static_cast<double>(lag) >= window * std::max(time, 1.0)) break;
  }
  return std::max(time, 1.0);
}

double student_t(double confidence, double degrees_of_freedom) {
  const boost::math::students_t distribution(std::max(1.0, degrees_of_freedom));
  return boost::math::quantile(distribution, 0.5 + 0.5 * confidence);
}

double two_sided_p(double deviation, double degrees_of_freedom, std::size_t numbers) {
  constexpr double as_good_as_known = 1e9;  // degrees of freedom
  if (std::isnan(deviation)) return deviation;
  if (std::isinf(deviation)) return 0.0;
  if (numbers <= 1) {
    const boost::math::students_t distribution(std::max(1.0, degrees_of_freedom));
    return 2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(deviation)));
  }
  const auto count = static_cast<double>(numbers);
  const double freedom = std::min(as_good_as_known, std::max(1.0, degrees_of_freedom));  // 1 of NaN
  const boost::math::fisher_f distribution(count, freedom);
  const double ratio = deviation * deviation / count;
  return std::isfinite(ratio) ? boost::math::cdf(boost::math::complement(distribution, ratio)) : 0.0;
}

double median_of(std::vector<double> values) {
  constexpr std::size_t many = 8192;
  const std::optional<double> median = values.size() < many ? std::nullopt : median_of_many(values);
  return median ? *median : boost::math::statistics::median(values);
}

double robust_deviation(std::vector<double> sizes) {
  constexpr double deviation_of_median = 1.4826;
  return sizes.empty() ? 0.0 : deviation_of_median * median_of(std::move(sizes));
}

}  // namespace kerf::fitting
