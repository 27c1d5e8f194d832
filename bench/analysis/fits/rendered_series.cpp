#include "fits/rendered_series.h"

#include <algorithm>
#include <cmath>

#include <kerf/drivers/velocity_filter.h>

#include "laws/sampled_motion.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr double ticks_a_row = 4.0;
constexpr double missing_s = 0.1;
constexpr double missing_rows = 20.0;

}  // namespace

RenderedSeries::RenderedSeries(const AxisSeries& series, double loop_rate_hz) {
  const std::size_t rows = series.time_s.size();
  const double row_s = rows > 1 ? quantile(periods_of(series.time_s), 0.5) : 1.0 / loop_rate_hz;
  const double period_s = std::max(1.0 / loop_rate_hz, row_s / ticks_a_row);
  const double latency_s = 1.0 / loop_rate_hz;
  const double longest_s = std::max(missing_s, missing_rows * row_s);
  drivers::VelocityFilter filter;
  std::vector<double> time_s;
  const auto tick = [&](double now_s, double position) {
    motion_.push_back({.penetration = position, .velocity = filter.update(0, position, now_s)});
    filter.advance(now_s);
    period_s_.push_back(time_s.empty() ? period_s : now_s - time_s.back());
    time_s.push_back(now_s);
  };
  for (std::size_t row = 0; row < rows; ++row) {
    const double now_s = series.time_s[row];
    if (row == 0 || now_s - series.time_s[row - 1] > longest_s) {
      tick(now_s, series.penetration[row]);
      continue;
    }
    const double before_s = series.time_s[row - 1];
    const double slope = (series.penetration[row] - series.penetration[row - 1]) / (now_s - before_s);
    for (double next_s = time_s.back() + period_s; next_s <= now_s + 1e-9; next_s = time_s.back() + period_s)
      tick(next_s, series.penetration[row - 1] + slope * (next_s - before_s));
  }
  for (const double now_s : series.time_s) {
    const auto after = std::ranges::upper_bound(time_s, now_s - latency_s + 1e-9);
    tick_.push_back(after == time_s.begin() ? 0 : static_cast<std::size_t>(after - time_s.begin()) - 1);
  }
  // Laws keep what they derive from the period: equal but for rounding is equal.
  for (double& one : period_s_) {
    if (std::abs(one - period_s) < 1e-6 * period_s) one = period_s;
  }
}

std::vector<double> RenderedSeries::force(const models::Law& law) const {
  const std::vector<double> of_ticks = law.along(motion_, period_s_);
  std::vector<double> of_rows;
  of_rows.reserve(tick_.size());
  for (const std::size_t tick : tick_) of_rows.push_back(of_ticks[tick]);
  return of_rows;
}

}  // namespace kerf::bench
