#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/students_t.hpp>

namespace kerf::fitting {
namespace {

constexpr double window = 5.0;

}  // namespace

double correlation_time(const std::vector<double>& residuals) {
  const std::size_t count = residuals.size();
  const double mean = std::accumulate(residuals.begin(), residuals.end(), 0.0) / static_cast<double>(count);
  std::vector<double> centred;
  for (const double r : residuals) centred.push_back(r - mean);
  const double variance = std::inner_product(centred.begin(), centred.end(), centred.begin(), 0.0);
  if (!(variance > 0.0)) return 1.0;
  double time = 1.0;
  for (std::size_t lag = 1; lag < count / 2; ++lag) {
    const auto later = centred.begin() + static_cast<std::ptrdiff_t>(lag);
    time += 2.0 * std::inner_product(later, centred.end(), centred.begin(), 0.0) / variance;
    if (static_cast<double>(lag) >= window * std::max(time, 1.0)) break;
  }
  return std::max(time, 1.0);
}

double student_t(double confidence, double degrees_of_freedom) {
  const boost::math::students_t distribution(std::max(1.0, degrees_of_freedom));
  return boost::math::quantile(distribution, 0.5 + 0.5 * confidence);
}

}  // namespace kerf::fitting
