#pragma once

#include <cstddef>
#include <vector>

#include <kerf/schema/recording.h>

#include "signal/filters.h"

namespace kerf::bench {

/// What a filter was and does at this recording's rate.
struct FilterReport {
  FilterSpec filter;
  double rate_hz = 0.0;
  std::size_t stretches = 1;        ///< filtered apart, where rows are missing between them
  std::vector<Response> responses;  ///< at 0.1, 0.2, 0.5, 1, ... 100 Hz, below half the rate
};

/// Filters the measured and commanded force of every axis, and with `position` position and velocity too.
/// Times that are not uniform are put on a uniform grid and back; stretches that more than ten periods part
/// are filtered apart. Axes without a finite value stay.
/// @throws std::invalid_argument for a value that is not finite, or a filter that does not fit the rate.
FilterReport apply_filter(schema::Recording& recording, const FilterSpec& filter, bool position);

}  // namespace kerf::bench
