#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

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

/// Standard deviation of white noise from row to row whose second differences have that median size: their
/// variance is six times its. Of a motion that is sampled finely they have next to nothing.
[[nodiscard]] inline double noise_of_second_differences(double median_size) {
  return deviation_of_mad * median_size / std::sqrt(6.0);
}

}  // namespace kerf::bench
