#include "signal/uniform_samples.h"

#include <algorithm>
#include <stdexcept>

#include "signal/quantiles.h"
#include "signal/signal.h"

namespace kerf::bench {

UniformSamples::UniformSamples(const std::vector<double>& time_s, double longest_gap_s) {
  const double period_s = median_period(time_s);
  if (!(period_s > 0.0))
    throw std::invalid_argument("a filter needs two samples or more, at times that increase");
  rate_hz_ = 1.0 / period_s;
  for (std::size_t begin = 0; begin < time_s.size();) {
    std::size_t end = begin + 1;
    while (end < time_s.size() && time_s[end] - time_s[end - 1] <= longest_gap_s) ++end;
    Stretch stretch{.begin = begin,
                    .time_s = {time_s.begin() + static_cast<std::ptrdiff_t>(begin),
                               time_s.begin() + static_cast<std::ptrdiff_t>(end)},
                    .grid_s = {}};
    const double span_s = stretch.time_s.back() - stretch.time_s.front();
    for (std::size_t i = 0; static_cast<double>(i) * period_s <= span_s; ++i) {
      stretch.grid_s.push_back(stretch.time_s.front() + static_cast<double>(i) * period_s);
    }
    stretches_.push_back(std::move(stretch));
    begin = end;
  }
}

std::vector<double> UniformSamples::filtered(const std::vector<double>& values, const Filter& filter) const {
  std::vector<double> result = values;
  for (const Stretch& stretch : stretches_) {
    if (stretch.grid_s.size() < 2) continue;
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(stretch.begin);
    const std::vector<double> own(begin, begin + static_cast<std::ptrdiff_t>(stretch.time_s.size()));
    const auto uniform = interpolate(stretch.time_s, own, stretch.grid_s);
    const auto back = interpolate(stretch.grid_s, filter(uniform), stretch.time_s);
    std::copy(back.begin(), back.end(), result.begin() + static_cast<std::ptrdiff_t>(stretch.begin));
  }
  return result;
}

}  // namespace kerf::bench
