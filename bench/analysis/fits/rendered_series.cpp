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
  const double most = ticks_a_row * static_cast<double>(rows) + 1.0;  // of rows that are not far apart
  const double usual = rows > 1 ? (series.time_s.back() - series.time_s.front()) / period_s + 2.0 : 1.0;
  const auto ticks = static_cast<std::size_t>(std::min(most, usual));
  motion_.reserve(ticks);
  period_s_.reserve(ticks);
  time_s.reserve(ticks);
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
  tick_.reserve(rows);
  std::size_t after = 0;  // the first tick that comes too late
  for (const double now_s : series.time_s) {
    while (after < time_s.size() && time_s[after] <= now_s - latency_s + 1e-9) ++after;
    tick_.push_back(static_cast<std::uint32_t>(after == 0 ? 0 : after - 1));
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
  for (const std::uint32_t tick : tick_) of_rows.push_back(of_ticks[tick]);
  return of_rows;
}

}  // namespace kerf::bench
