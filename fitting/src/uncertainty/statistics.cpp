#include "uncertainty/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numeric>

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

double robust_deviation(std::vector<double> sizes) {
  constexpr double deviation_of_median = 1.4826;
  return sizes.empty() ? 0.0 : deviation_of_median * boost::math::statistics::median(sizes);
}

}  // namespace kerf::fitting
