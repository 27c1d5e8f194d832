#pragma once

#include "laws/sampled_motion.h"
#include "recordings/axis_series.h"

namespace kerf::bench {

/// The stretch of a recording that laws are timed along: that with most contact, of 4,000 rows at most, as
/// penetration on one axis. @param period_s between its ticks
[[nodiscard]] SampledMotion timed_stretch(const AxisSeries& series, double period_s);

}  // namespace kerf::bench
