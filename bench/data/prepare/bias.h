#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// How many rows count as one independent one: (1 + r) / (1 - r), with r the correlation of neighbouring
/// residuals (an autoregressive process of first order), at least 1.
[[nodiscard]] double rows_that_count_as_one(const std::vector<double>& residuals);

/// What was taken off the force of one axis.
struct AxisBias {
  std::string axis;
  std::string unit;
  double offset = 0.0;            ///< at the recording's first row
  double offset_error = 0.0;      ///< standard error
  double drift_per_minute = 0.0;  ///< zero unless asked for
  double drift_per_minute_error = 0.0;
  double noise = 0.0;             ///< standard deviation of the free rows about it
  double correlation_rows = 1.0;  ///< rows that count as one
};

struct Bias {
  std::vector<AxisBias> axes;
  std::size_t rows = 0;  ///< free rows that it comes from
};

/// Takes off the measured force of every axis what it is while the tool touches nothing:
///
///     f(t) = offset + drift (t - t0)
///
/// by least squares over the free rows; without `drift` the offset alone, their mean. Standard errors count
/// only as many rows as are independent by the correlation of neighbours. Axes without a finite force stay.
/// @throws std::invalid_argument without measured force, with fewer than ten free rows, or for a drift
/// without ten free rows in the first and in the last quarter of the time, since a line through one end alone
/// says nothing of the other.
Bias remove_bias(schema::Recording& recording, const std::vector<bool>& free, bool drift);

}  // namespace kerf::bench
