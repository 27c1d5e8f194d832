#pragma once

#include <optional>
#include <span>

#include "recordings/row_span.h"
#include "signal/blocked_values.h"

namespace kerf::bench {

/// How a signal goes away from its level while nothing is touched, in its own unit.
struct Drift {
  double level = 0.0;       ///< median of the windows' means
  double per_s = 0.0;       ///< slope
  double over_all = 0.0;    ///< slope times the time from the first row to the last
  double scatter = 0.0;     ///< of the windows about the line: standard deviation, from their median size
  std::size_t windows = 0;  ///< of 16, those with twenty idle rows and more
};

/// The straight line through the means of the rows outside the contacts in 16 windows of equal time: its
/// slope is the median of those between all pairs of windows (Theil and Sen), so that a few windows in which
/// the tool met something unseen do not turn it. None with fewer than four windows that hold twenty idle
/// rows.
[[nodiscard]] std::optional<Drift> drift_of(const BlockedValues& time_s, const BlockedValues& values,
                                            std::span<const RowSpan> contacts);

}  // namespace kerf::bench
