#pragma once

#include <cstddef>
#include <vector>

#include <kerf/fitting/fit.h>
#include <kerf/schema/recording.h>

#include "laws/render.h"

namespace kerf::bench {

/// An axis of a recording as fits and their reports see it: only rows that are finite, and in place of the
/// velocity of a device, which lags, the zero-phase slope of its positions (a parabola over 20 ms, at least
/// five samples).
struct FitSeries {
  AxisSeries axis;
  std::size_t left_out = 0;  ///< rows that are not finite

  [[nodiscard]] fitting::Series view(double noise_n = 0.0) const;
};

/// @throws std::invalid_argument (no such axis, no force).
[[nodiscard]] FitSeries fit_series(const schema::Recording& recording, std::size_t axis,
                                   const models::Contact& contact);

/// Several one after the other, as figures over all of them need; not a series in time.
[[nodiscard]] AxisSeries pooled(const std::vector<FitSeries>& all);

}  // namespace kerf::bench
