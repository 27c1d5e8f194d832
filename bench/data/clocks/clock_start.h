#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "clocks/clock_fit.h"

namespace kerf::bench {

/// A correlation below this one is of two series that have nothing in common.
inline constexpr double least_clock_correlation = 0.5;

/// Values on a uniform grid, between which a cubic runs.
struct GridSeries {
  double begin_s = 0.0;
  double period_s = 1.0;
  std::vector<double> values;

  [[nodiscard]] double end_s() const { return begin_s + period_s * static_cast<double>(values.size() - 1); }
  [[nodiscard]] double slope_at(std::size_t i) const;
};

struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// None where the grid does not reach.
[[nodiscard]] std::optional<ValueAndSlope> at(const GridSeries& series, double time_s);

/// Filtered on a grid of its own rate, then laid on one of the period that is asked for.
[[nodiscard]] GridSeries on_grid(const ClockedSeries& series, double own_period_s, double period_s);

/// The correlation coefficient of two series of one length.
[[nodiscard]] double correlation_of(const std::vector<double>& a, const std::vector<double>& b);

/// The best shift of a skew, and the best of the others that are a peak of their own.
struct ClockStart {
  double shift_s = 0.0;
  double skew = 0.0;
  double correlation = -1.0;
  double rival = -1.0;
  double rival_shift_s = 0.0;
};

/// The largest correlation over all shifts with a quarter of overlap, for skews of 0 to +-5e-3, of series
/// that are thinned to some 2,000 values.
/// @throws std::invalid_argument (without a file's name) if they have nothing in common, or another shift
///         serves nearly as well.
[[nodiscard]] ClockStart best_start(const GridSeries& first, const GridSeries& other);

}  // namespace kerf::bench
