#pragma once

#include <cstddef>
#include <vector>

namespace kerf::fitting {

/// Integrated autocorrelation time in samples, 1 + 2 sum rho(k), summed over Sokal's window: up to the first
/// lag that is five times the sum so far. 1 for white noise, never less.
[[nodiscard]] double correlation_time(const std::vector<double>& residuals);

/// Two-sided quantile of Student's t: the interval is estimate +- t * standard error.
[[nodiscard]] double student_t(double confidence, double degrees_of_freedom);

/// How likely a deviation as large as this is, of either sign, by Student's t; of several numbers at once
/// that are free to make it, by Fisher's F.
/// @param deviation in standard errors
[[nodiscard]] double two_sided_p(double deviation, double degrees_of_freedom, std::size_t numbers = 1);

/// The value in the middle, or the mean of the two there. @param values at least one, all finite
[[nodiscard]] double median_of(std::vector<double> values);

/// Standard deviation of normal noise by the median of its sizes, 1.4826 times that: a few that are
/// no noise do not move it. 0 of none.
[[nodiscard]] double robust_deviation(std::vector<double> sizes);

}  // namespace kerf::fitting
