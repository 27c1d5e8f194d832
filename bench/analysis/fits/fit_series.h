#pragma once

#include <kerf/fitting/fit.h>
#include <kerf/schema/recording.h>

#include "recordings/axis_series.h"

namespace kerf::bench {

/// A series as a fit takes it. It must outlive what is returned.
[[nodiscard]] inline fitting::Series fitted_view(const AxisSeries& series, double noise_n = 0.0,
                                                 double contact_error = 0.0) {
  return {.time_s = series.time_s,
          .penetration = series.penetration,
          .velocity = series.velocity,
          .force = series.force,
          .cycle = series.cycle,
          .noise_n = noise_n,
          .counts = series.counts,
          .contact_error = contact_error};
}

/// Verdicts by the JND of what an axis exerts.
inline void take_jnd_of(const schema::Axis& axis, fitting::FitOptions& options) {
  options.jnd = fitting::jnd_of(axis.force_unit, axis.lever);
  options.jnd_source = fitting::jnd_source_of(axis.force_unit, axis.lever);
}

}  // namespace kerf::bench
