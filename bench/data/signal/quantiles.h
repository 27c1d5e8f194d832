#pragma once

#include <span>
#include <vector>

namespace kerf::bench {

/// The middle value, or the mean of the two middle ones. Requires at least one value.
[[nodiscard]] double median(std::vector<double> values);

/// The value below which that share of them lies, between two of them by distance: 0 is the smallest, 0.5 the
/// median, 1 the largest. NaN without values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// Median step between times that increase; 0 for less than two of them.
[[nodiscard]] double median_period(std::span<const double> time_s);

}  // namespace kerf::bench
