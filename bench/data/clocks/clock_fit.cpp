#include "clocks/clock_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "signal/quantiles.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t fewest_rows = 64;
constexpr std::size_t coarse_rows = 2048;
constexpr std::array start_skews{0.0, 5e-4, -5e-4, 1e-3, -1e-3, 2e-3, -2e-3, 5e-3, -5e-3};
constexpr double least_correlation = 0.5;
constexpr double corner_of_rate = 0.2;

/// Values on a uniform grid, between which a cubic runs.
struct GridSeries {
  double begin_s = 0.0;
  double period_s = 1.0;
  std::vector<double> values;

  [[nodiscard]] double end_s() const { return begin_s + period_s * static_cast<double>(values.size() - 1); }
  [[nodiscard]] double slope_at(std::size_t i) const {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, values.size() - 1);
    return (values[after] - values[before]) / (static_cast<double>(after - before) * period_s);
  }
};

struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// None where the grid does not reach.
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

/// Filtered on a grid of its own rate, then laid on one of the period that is asked for.
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

/// The best shift of a skew, and the best of the others that are a peak of their own.
struct CoarseStart {
  double shift_s = 0.0;
  double skew = 0.0;
  double correlation = -1.0;
  double rival = -1.0;
  double rival_shift_s = 0.0;
};

std::vector<double> centred(std::vector<double> values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return values;
}

CoarseStart coarse_start(const GridSeries& first, const GridSeries& other, double skew) {
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
  CoarseStart start{.shift_s = shift_of(best), .skew = skew, .correlation = r[best]};
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

CoarseStart best_start(const GridSeries& first, const GridSeries& other) {
  const std::size_t longest = std::max(first.values.size(), other.values.size());
  const std::size_t step = (longest + coarse_rows - 1) / coarse_rows;
  const GridSeries a = coarser(first, step);
  const GridSeries b = coarser(other, step);
  CoarseStart best;
  for (const double skew : start_skews) {
    const CoarseStart start = coarse_start(a, b, skew);
    if (start.correlation > best.correlation) best = start;
  }
  if (best.correlation < least_correlation)
    throw std::invalid_argument(fmt::format(
        "the two have nothing in common: their largest correlation is {:.2f}, expected {} or more",
        best.correlation, least_correlation));
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

constexpr std::size_t unknowns = 4;  ///< shift, skew, gain, offset
using Vector = std::array<double, unknowns>;

/// The equations Z^T (a - g b - o) = 0, linear around a point: Z of slope and values of b.
struct Equations {
  std::array<Vector, unknowns> matrix{};
  Vector right{};

  void add(const Vector& instrument, const Vector& slopes, double residual) {
    for (std::size_t i = 0; i < unknowns; ++i) {
      for (std::size_t k = 0; k < unknowns; ++k) matrix[i][k] += instrument[i] * slopes[k];
      right[i] += instrument[i] * residual;
    }
  }
  void add(const Equations& other, double times) {
    for (std::size_t i = 0; i < unknowns; ++i) {
      for (std::size_t k = 0; k < unknowns; ++k) matrix[i][k] += times * other.matrix[i][k];
      right[i] += times * other.right[i];
    }
  }
};

/// By Gauss with pivots, on rows and columns of one scale; none if they do not determine it.
std::optional<Vector> solved(Equations e) {
  Vector scale{};
  for (std::size_t i = 0; i < unknowns; ++i) scale[i] = std::sqrt(std::abs(e.matrix[i][i]));
  for (std::size_t i = 0; i < unknowns; ++i) {
    if (!(scale[i] > 0.0)) return std::nullopt;
    e.right[i] /= scale[i];
    for (std::size_t k = 0; k < unknowns; ++k) e.matrix[i][k] /= scale[i] * scale[k];
  }
  for (std::size_t i = 0; i < unknowns; ++i) {
    std::size_t pivot = i;
    for (std::size_t k = i + 1; k < unknowns; ++k)
      if (std::abs(e.matrix[k][i]) > std::abs(e.matrix[pivot][i])) pivot = k;
    if (!(std::abs(e.matrix[pivot][i]) > 1e-9)) return std::nullopt;
    std::swap(e.matrix[i], e.matrix[pivot]);
    std::swap(e.right[i], e.right[pivot]);
    for (std::size_t k = i + 1; k < unknowns; ++k) {
      const double factor = e.matrix[k][i] / e.matrix[i][i];
      for (std::size_t c = i; c < unknowns; ++c) e.matrix[k][c] -= factor * e.matrix[i][c];
      e.right[k] -= factor * e.right[i];
    }
  }
  Vector x{};
  for (std::size_t i = unknowns; i-- > 0;) {
    x[i] = e.right[i];
    for (std::size_t k = i + 1; k < unknowns; ++k) x[i] -= e.matrix[i][k] * x[k];
    x[i] /= e.matrix[i][i];
  }
  for (std::size_t i = 0; i < unknowns; ++i) x[i] /= scale[i];
  return x;
}

/// A point of the search, and what it says of the two series.
class Comparison {
 public:
  Comparison(const GridSeries& first, const GridSeries& other) : first_(first), other_(other) {}

  /// Equations of each block of the other's rows. The skew counts from `middle_s` of the other clock, where
  /// shift and skew are nearly independent of each other.
  std::array<Equations, clock_blocks> equations(const Vector& x, double middle_s) {
    std::array<Equations, clock_blocks> blocks{};
    a_.clear();
    b_.clear();
    const auto [begin, end] = overlap(x, middle_s);
    for (std::size_t i = begin; i < end; ++i) {
      const double t = other_.begin_s + other_.period_s * static_cast<double>(i);
      const auto a = at(first_, x[0] + (1.0 + x[1]) * (t - middle_s) + middle_s);
      if (!a) continue;
      const double b = other_.values[i];
      const double slope = x[2] * other_.slope_at(i);
      const std::size_t block = (i - begin) * clock_blocks / (end - begin);
      blocks.at(block).add({slope, slope * (t - middle_s), b, 1.0},
                           {a->slope, a->slope * (t - middle_s), -b, -1.0}, x[2] * b + x[3] - a->value);
      a_.push_back(a->value);
      b_.push_back(b);
    }
    return blocks;
  }

  [[nodiscard]] double correlation() const { return correlation_at(centred(a_), centred(b_), 0); }
  [[nodiscard]] std::size_t rows() const noexcept { return a_.size(); }
  /// Least squares of a by b at the last point.
  [[nodiscard]] std::pair<double, double> gain_and_offset() const {
    double sb = 0.0;
    double sa = 0.0;
    double sbb = 0.0;
    double sab = 0.0;
    const auto n = static_cast<double>(a_.size());
    for (std::size_t i = 0; i < a_.size(); ++i) {
      sa += a_[i];
      sb += b_[i];
      sbb += b_[i] * b_[i];
      sab += a_[i] * b_[i];
    }
    const double gain = (sab - sa * sb / n) / (sbb - sb * sb / n);
    return {gain, (sa - gain * sb) / n};
  }

 private:
  [[nodiscard]] std::pair<std::size_t, std::size_t> overlap(const Vector& x, double middle_s) const {
    const auto row_of = [&](double first_s) {
      const double t = (first_s - x[0] - middle_s) / (1.0 + x[1]) + middle_s;
      return std::clamp((t - other_.begin_s) / other_.period_s, 0.0,
                        static_cast<double>(other_.values.size()));
    };
    const auto begin = static_cast<std::size_t>(std::ceil(row_of(first_.begin_s)));
    const auto end = static_cast<std::size_t>(row_of(first_.end_s()));
    return {begin, std::max(begin + 1, end)};
  }

  const GridSeries& first_;
  const GridSeries& other_;
  std::vector<double> a_;
  std::vector<double> b_;
};

[[noreturn]] void refuse_undetermined() {
  throw std::invalid_argument(
      "the two do not determine shift and skew: too little happens where they overlap");
}

/// The jackknife: what the answer does when one block is left out. The shift is that at time 0 of the other.
Vector standard_errors(const std::array<Equations, clock_blocks>& blocks, const Equations& all,
                       double middle_s) {
  std::array<Vector, clock_blocks> steps{};
  Vector mean{};
  for (std::size_t block = 0; block < clock_blocks; ++block) {
    Equations others = all;
    others.add(blocks.at(block), -1.0);
    auto step = solved(others);
    if (!step) refuse_undetermined();
    (*step)[0] -= (*step)[1] * middle_s;
    steps.at(block) = *step;
    for (std::size_t i = 0; i < unknowns; ++i) mean[i] += (*step)[i] / static_cast<double>(clock_blocks);
  }
  Vector errors{};
  for (const Vector& step : steps)
    for (std::size_t i = 0; i < unknowns; ++i) errors[i] += (step[i] - mean[i]) * (step[i] - mean[i]);
  for (double& error : errors)
    error = std::sqrt(error * static_cast<double>(clock_blocks - 1) / static_cast<double>(clock_blocks));
  return errors;
}

Equations sum_of(const std::array<Equations, clock_blocks>& blocks) {
  Equations all;
  for (const Equations& block : blocks) all.add(block, 1.0);
  return all;
}

/// From a start to where the equations hold. `x` has the shift at `middle_s`.
void solve_from(Comparison& comparison, Vector& x, double middle_s, double period_s) {
  constexpr int most_steps = 60;
  (void)comparison.equations(x, middle_s);
  if (comparison.rows() < fewest_rows) refuse_undetermined();
  std::tie(x[2], x[3]) = comparison.gain_and_offset();
  for (int step = 0; step < most_steps; ++step) {
    const auto dx = solved(sum_of(comparison.equations(x, middle_s)));
    if (!dx || comparison.rows() < fewest_rows) refuse_undetermined();
    const double largest = 5.0 * period_s + 0.01 * std::abs((*dx)[0]);
    const double part = std::min(1.0, largest / std::max(std::abs((*dx)[0]), 1e-300));
    for (std::size_t i = 0; i < unknowns; ++i) x[i] += part * (*dx)[i];
    if (part == 1.0 && std::abs((*dx)[0]) < 1e-9 * period_s) return;
  }
}

}  // namespace

ClockFit fit_clock(const ClockedSeries& first, const ClockedSeries& other) {
  if (std::min(first.time_s.size(), other.time_s.size()) < fewest_rows)
    throw std::invalid_argument(fmt::format("{} and {} rows; expected {} and more of each to compare clocks",
                                            first.time_s.size(), other.time_s.size(), fewest_rows));
  const double first_period_s = median_period(first.time_s);
  const double other_period_s = median_period(other.time_s);
  const double period_s = std::max(first_period_s, other_period_s);
  const GridSeries a = on_grid(first, first_period_s, period_s);
  const GridSeries b = on_grid(other, other_period_s, period_s);
  if (std::min(a.values.size(), b.values.size()) < fewest_rows) refuse_undetermined();

  const CoarseStart start = best_start(a, b);
  const double begin_s = std::max(b.begin_s, (a.begin_s - start.shift_s) / (1.0 + start.skew));
  const double end_s = std::min(b.end_s(), (a.end_s() - start.shift_s) / (1.0 + start.skew));
  const double middle_s = 0.5 * (begin_s + end_s);
  Vector x{start.shift_s + start.skew * middle_s, start.skew, 1.0, 0.0};
  Comparison comparison(a, b);
  solve_from(comparison, x, middle_s, period_s);
  const auto blocks = comparison.equations(x, middle_s);
  const Vector errors = standard_errors(blocks, sum_of(blocks), middle_s);
  const double correlation = comparison.correlation();
  if (!(correlation >= least_correlation) || !(errors[0] < 0.25 * (end_s - begin_s))) refuse_undetermined();
  return {.shift_s = x[0] - x[1] * middle_s,
          .skew = x[1],
          .shift_error_s = errors[0],
          .skew_error = errors[1],
          .correlation = correlation,
          .rows = comparison.rows()};
}

}  // namespace kerf::bench
