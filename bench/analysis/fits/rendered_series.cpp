#include "fits/rendered_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <span>

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
  const bool is_coarse = period_s > latency_s;
  const double longest_s = std::max(missing_s, missing_rows * row_s);
  drivers::VelocityFilter filter;
  const double most =
      (ticks_a_row + 1.0) * static_cast<double>(rows) + 1.0;  // of rows that are not far apart
  const double usual = rows > 1 ? (series.time_s.back() - series.time_s.front()) / period_s + 2.0 : 1.0;
  const auto ticks = static_cast<std::size_t>(is_coarse ? most : std::min(most, usual));
  motion_.reserve(ticks);
  period_s_.reserve(ticks);
  tick_.reserve(rows);
  double last_s = 0.0;
  std::deque<double> not_yet_s;  // ticks whose command the rows so far have not felt
  const auto tick = [&](double now_s, double position) {
    motion_.push_back({.penetration = position, .velocity = filter.update(0, position, now_s)});
    filter.advance(now_s);
    period_s_.push_back(period_s_.empty() ? period_s : now_s - last_s);
    last_s = now_s;
    not_yet_s.push_back(now_s);
  };
  const auto felt_at = [&](double now_s) {
    while (!not_yet_s.empty() && not_yet_s.front() <= now_s - latency_s + 1e-9) not_yet_s.pop_front();
    const std::size_t felt = motion_.size() - not_yet_s.size();
    tick_.push_back(static_cast<std::uint32_t>(felt == 0 ? 0 : felt - 1));
  };
  for (std::size_t row = 0; row < rows; ++row) {
    const double now_s = series.time_s[row];
    if (row == 0 || now_s - series.time_s[row - 1] > longest_s) {
      tick(now_s, series.penetration[row]);
    } else {
      const double before_s = series.time_s[row - 1];
      const double slope = (series.penetration[row] - series.penetration[row - 1]) / (now_s - before_s);
      const double until_s = is_coarse ? now_s - latency_s : now_s + 1e-9;
      const auto at = [&](double next_s) {
        tick(next_s, series.penetration[row - 1] + slope * (next_s - before_s));
      };
      for (double next_s = last_s + period_s; next_s <= until_s; next_s = last_s + period_s) at(next_s);
      if (is_coarse && until_s > last_s) at(until_s);
    }
    felt_at(now_s);
  }
  // Laws keep what they derive from the period: equal but for rounding is equal.
  for (double& one : period_s_) {
    if (std::abs(one - period_s) < 1e-6 * period_s) one = period_s;
  }
  const bool even = std::ranges::all_of(period_s_, [&](double one) { return one == period_s; });
  if (even) period_s_ = std::vector<double>{period_s};
}

std::vector<double> RenderedSeries::force(const models::Law& law) const {
  std::vector<double> of_rows;
  of_rows.reserve(tick_.size());
  std::array<double, 4096> of_ticks{};  // at once: all would be one column more
  models::Law::State state = law.initial_state();
  for (std::size_t begin = 0; begin < motion_.size(); begin += of_ticks.size()) {
    const std::size_t count = std::min(of_ticks.size(), motion_.size() - begin);
    const std::span<const double> periods(period_s_);
    law.steps(state, std::span(motion_).subspan(begin, count),
              periods.size() == 1 ? periods : periods.subspan(begin, count),
              std::span(of_ticks).first(count));
    for (; of_rows.size() < tick_.size() && tick_[of_rows.size()] < begin + count;) {
      const double force = of_ticks[tick_[of_rows.size()] - begin];
      of_rows.push_back(std::isnan(force) ? 0.0 : force);  // as step() faults
    }
  }
  return of_rows;
}

}  // namespace kerf::bench
