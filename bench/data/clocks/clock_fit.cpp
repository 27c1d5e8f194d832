#include "clocks/clock_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "clocks/clock_start.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr std::size_t fewest_rows = 64;

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

  [[nodiscard]] double correlation() const { return correlation_of(a_, b_); }
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

  const ClockStart start = best_start(a, b);
  const double begin_s = std::max(b.begin_s, (a.begin_s - start.shift_s) / (1.0 + start.skew));
  const double end_s = std::min(b.end_s(), (a.end_s() - start.shift_s) / (1.0 + start.skew));
  const double middle_s = 0.5 * (begin_s + end_s);
  Vector x{start.shift_s + start.skew * middle_s, start.skew, 1.0, 0.0};
  Comparison comparison(a, b);
  solve_from(comparison, x, middle_s, period_s);
  const auto blocks = comparison.equations(x, middle_s);
  const Vector errors = standard_errors(blocks, sum_of(blocks), middle_s);
  const double correlation = comparison.correlation();
  if (!(correlation >= least_clock_correlation) || !(errors[0] < 0.25 * (end_s - begin_s)))
    refuse_undetermined();
  return {.shift_s = x[0] - x[1] * middle_s,
          .skew = x[1],
          .shift_error_s = errors[0],
          .skew_error = errors[1],
          .correlation = correlation,
          .rows = comparison.rows()};
}

}  // namespace kerf::bench
