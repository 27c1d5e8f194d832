#pragma once

#include <string>

#include <kerf/fitting/fit.h>

#include "recordings/axis_series.h"

namespace kerf::bench {

/// Where a force that counts stands at an end of its range while the tool moves on, as ends_of_force() has it
/// and by more than is felt: what is clipped no law gives back. Else empty.
[[nodiscard]] std::string clipped_force(const AxisSeries& series, const fitting::FitOptions& settings);

/// Where the force at the tool's least engagement (within 2 % of the range of penetration) goes along a
/// straight line in time by more than the JND of the whole, over the recording, as drift_of() has it: no law
/// of the motion does. Else empty.
[[nodiscard]] std::string drifting_force(const AxisSeries& series, const fitting::FitOptions& settings);

}  // namespace kerf::bench
