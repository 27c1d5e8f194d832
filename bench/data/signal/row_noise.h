#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "signal/quantiles.h"

namespace kerf::bench {

/// Of normal noise: its standard deviation over the median of its sizes.
inline constexpr double deviation_of_mad = 1.4826;

/// Calls `look` with |x(i-1) - 2 x(i) + x(i+1)| of every row i between two others that `counts`, in order;
/// what is not finite is passed over.
template <typename Values, typename Counts, typename Look>
void each_second_difference(const Values& values, const Counts& counts, const Look& look) {
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    if (!counts(i)) continue;
    const double size = std::abs(values[i + 1] - 2.0 * values[i] + values[i - 1]);
    if (std::isfinite(size)) look(size);
  }
}

/// How many times the noise a single row stands out by.
inline constexpr double stands_out = 8.0;

/// Calls `look` with the row, and its height over the nearer neighbour, of every row that `counts` and stands
/// out from both its neighbours in one direction by more than stands_out times a noise.
template <typename Values, typename Counts, typename Look>
void each_single_row(const Values& values, const Counts& counts, double noise, const Look& look) {
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    if (!counts(i)) continue;
    const double over_last = values[i] - values[i - 1];
    const double over_next = values[i] - values[i + 1];
    if (!(over_last * over_next > 0.0)) continue;
    const double height = std::min(std::abs(over_last), std::abs(over_next));
    if (height > stands_out * noise && std::isfinite(height)) look(i, height);
  }
}

/// Calls `look` with the row, and its height over the nearer neighbour, of every row of a motion that jumps
/// there and back: by more than stands_out times what all but a hundredth of its steps do, and twice what it
/// does just before and after, which no turn of a tool does.
template <typename Look>
void each_jump_and_back(std::span<const double> position, const Look& look) {
  constexpr std::size_t looked_at = 100'000;
  const std::size_t stride = std::max<std::size_t>(1, position.size() / looked_at);
  std::vector<double> steps;
  for (std::size_t i = 1; i < position.size(); i += stride) {
    const double step = std::abs(position[i] - position[i - 1]);
    if (std::isfinite(step)) steps.push_back(step);
  }
  const double usual = quantile(std::move(steps), 0.99);
  if (!(usual > 0.0)) return;
  const auto is_calm = [&](std::size_t row, std::size_t next, double height) {
    return next >= position.size() || !(std::abs(position[row] - position[next]) > 0.5 * height);
  };
  each_single_row(
      position, [](std::size_t) { return true; }, usual,
      [&](std::size_t row, double height) {
        if (is_calm(row + 1, row + 2, height) && (row < 2 || is_calm(row - 1, row - 2, height)))
          look(row, height);
      });
}

/// Standard deviation of white noise from row to row whose second differences have that median size: their
/// variance is six times its. Of a motion that is sampled finely they have next to nothing.
[[nodiscard]] inline double noise_of_second_differences(double median_size) {
  return deviation_of_mad * median_size / std::sqrt(6.0);
}

}  // namespace kerf::bench
