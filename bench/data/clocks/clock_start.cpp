#include "clocks/clock_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t coarse_rows = 2048;
constexpr std::array start_skews{0.0, 5e-4, -5e-4, 1e-3, -1e-3, 2e-3, -2e-3, 5e-3, -5e-3};
constexpr double corner_of_rate = 0.2;

/// Every n-th value of a series, smoothed before.
GridSeries coarser(const GridSeries& series, std::size_t step) {
  if (step <= 1) return series;
  const double rate_hz = 1.0 / series.period_s;
  const std::vector<double> smooth =
      low_pass_zero_phase(series.values, rate_hz, corner_of_rate * rate_hz / static_cast<double>(step));
  GridSeries coarse{
      .begin_s = series.begin_s, .period_s = series.period_s * static_cast<double>(step), .values = {}};
  for (std::size_t i = 0; i < smooth.size(); i += step) coarse.values.push_back(smooth[i]);
  return coarse;
}

/// The correlation coefficient of a[i + lag] and b[i] where both are.
double correlation_at(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t lag) {
  const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, -lag);
  const auto end =
      std::min(static_cast<std::ptrdiff_t>(b.size()), static_cast<std::ptrdiff_t>(a.size()) - lag);
  double sa = 0.0;
  double sb = 0.0;
  double saa = 0.0;
  double sbb = 0.0;
  double sab = 0.0;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double x = a[static_cast<std::size_t>(i + lag)];
    const double y = b[static_cast<std::size_t>(i)];
    sa += x;
    sb += y;
    saa += x * x;
    sbb += y * y;
    sab += x * y;
  }
  const auto n = static_cast<double>(end - begin);
  const double va = saa - sa * sa / n;
  const double vb = sbb - sb * sb / n;
  return va > 0.0 && vb > 0.0 ? (sab - sa * sb / n) / std::sqrt(va * vb) : 0.0;
}

std::vector<double> centred(std::vector<double> values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return values;
}

ClockStart coarse_start(const GridSeries& first, const GridSeries& other, double skew) {
  // The other's samples in the first one's seconds.
  GridSeries stretched = other;
  stretched.values.clear();
  for (std::size_t i = 0;; ++i) {
    const auto value = at(other, other.begin_s + first.period_s * static_cast<double>(i) / (1.0 + skew));
    if (!value) break;
    stretched.values.push_back(value->value);
  }
  const std::vector<double> a = centred(first.values);
  const std::vector<double> b = centred(stretched.values);
  const auto shortest = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  const std::ptrdiff_t overlap = std::max<std::ptrdiff_t>(shortest / 4, 8);
  const std::ptrdiff_t from = overlap - static_cast<std::ptrdiff_t>(b.size());
  const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(a.size()) - overlap;
  std::vector<double> r;
  for (std::ptrdiff_t lag = from; lag <= to; ++lag) r.push_back(correlation_at(a, b, lag));
  if (r.empty()) return {};
  const auto best = static_cast<std::size_t>(std::max_element(r.begin(), r.end()) - r.begin());
  const auto shift_of = [&](std::size_t i) {
    return first.begin_s + first.period_s * static_cast<double>(from + static_cast<std::ptrdiff_t>(i)) -
           (1.0 + skew) * other.begin_s;
  };
  ClockStart start{.shift_s = shift_of(best), .skew = skew, .correlation = r[best]};
  std::size_t left = best;
  while (left > 0 && r[left - 1] <= r[left]) --left;
  std::size_t right = best;
  while (right + 1 < r.size() && r[right + 1] <= r[right]) ++right;
  for (std::size_t i = 0; i < r.size(); ++i) {
    if ((i < left || i > right) && r[i] > start.rival) {
      start.rival = r[i];
      start.rival_shift_s = shift_of(i);
    }
  }
  return start;
}

}  // namespace

double GridSeries::slope_at(std::size_t i) const {
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t after = std::min(i + 1, values.size() - 1);
  return (values[after] - values[before]) / (static_cast<double>(after - before) * period_s);
}

std::optional<ValueAndSlope> at(const GridSeries& series, double time_s) {
  const double place = (time_s - series.begin_s) / series.period_s;
  if (!(place >= 0.0) || !(place < static_cast<double>(series.values.size() - 1))) return std::nullopt;
  const auto i = static_cast<std::size_t>(place);
  const double u = place - static_cast<double>(i);
  const double left = series.values[i];
  const double right = series.values[i + 1];
  const double m0 = series.slope_at(i) * series.period_s;
  const double m1 = series.slope_at(i + 1) * series.period_s;
  const double c2 = 3.0 * (right - left) - 2.0 * m0 - m1;
  const double c3 = 2.0 * (left - right) + m0 + m1;
  return ValueAndSlope{.value = left + u * (m0 + u * (c2 + u * c3)),
                       .slope = (m0 + u * (2.0 * c2 + u * 3.0 * c3)) / series.period_s};
}

GridSeries on_grid(const ClockedSeries& series, double own_period_s, double period_s) {
  const auto grid_of = [&](double step_s) {
    std::vector<double> times;
    for (double t = series.time_s.front(); t <= series.time_s.back();
         t = series.time_s.front() + step_s * static_cast<double>(times.size()))
      times.push_back(t);
    return times;
  };
  const std::vector<double> own = grid_of(own_period_s);
  const std::vector<double> smooth = low_pass_zero_phase(interpolate(series.time_s, series.values, own),
                                                         1.0 / own_period_s, corner_of_rate / period_s);
  return {.begin_s = series.time_s.front(),
          .period_s = period_s,
          .values = interpolate(own, smooth, grid_of(period_s))};
}

double correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
  return correlation_at(centred(a), centred(b), 0);
}

ClockStart best_start(const GridSeries& first, const GridSeries& other) {
  const std::size_t longest = std::max(first.values.size(), other.values.size());
  const std::size_t step = (longest + coarse_rows - 1) / coarse_rows;
  const GridSeries a = coarser(first, step);
  const GridSeries b = coarser(other, step);
  ClockStart best;
  for (const double skew : start_skews) {
    const ClockStart start = coarse_start(a, b, skew);
    if (start.correlation > best.correlation) best = start;
  }
  if (best.correlation < least_clock_correlation)
    throw std::invalid_argument(fmt::format(
        "the two have nothing in common: their largest correlation is {:.2f}, expected {} or more",
        best.correlation, least_clock_correlation));
  // By what a shift leaves unexplained: half as much again is no other answer.
  constexpr double as_good = 1.5;
  if (best.rival > 0.0 &&
      1.0 - best.rival * best.rival < as_good * (1.0 - best.correlation * best.correlation) + 1e-6)
    throw std::invalid_argument(
        fmt::format("shifts of {:.3f} s and {:.3f} s serve alike (correlations {:.4f} and {:.4f}): cycles "
                    "that are all alike "
                    "do not tell which is which; a column with a marker would, or a shared time",
                    best.shift_s, best.rival_shift_s, best.correlation, best.rival));
  return best;
}

}  // namespace kerf::bench
