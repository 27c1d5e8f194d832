#include "signal/quantiles.h"

#include <algorithm>
#include <limits>

#include <boost/math/statistics/univariate_statistics.hpp>

namespace kerf::bench {

double median(std::vector<double> values) { return boost::math::statistics::median(values); }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), below, values.end());
  const auto above = std::min_element(below + 1, values.end());
  if (above == values.end()) return *below;
  return *below + (place - static_cast<double>(below - values.begin())) * (*above - *below);
}

double median_period(std::span<const double> time_s) {
  std::vector<double> periods;
  periods.reserve(time_s.size());
  for (std::size_t i = 1; i < time_s.size(); ++i) periods.push_back(time_s[i] - time_s[i - 1]);
  return periods.empty() ? 0.0 : median(std::move(periods));
}

}  // namespace kerf::bench
