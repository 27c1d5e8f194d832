#pragma once

#include <kerf/fitting/fit.h>

#include "recordings/axis_series.h"

namespace kerf::bench {

/// A series as a fit takes it. It must outlive what is returned.
[[nodiscard]] inline fitting::Series fitted_view(const AxisSeries& series, double noise_n = 0.0) {
  return {.time_s = series.time_s,
          .penetration = series.penetration,
          .velocity = series.velocity,
          .force = series.force,
          .cycle = series.cycle,
          .noise_n = noise_n};
}

}  // namespace kerf::bench
