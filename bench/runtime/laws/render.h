#pragma once

#include <vector>

#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

#include "recordings/axis_series.h"

namespace kerf::bench {

/// The contact of a recording: that of the tissue in its scene if it was simulated, else the onset that
/// `kerf prepare` found, else from its cycles if it was segmented, else the smallest position with direction
/// +1.
[[nodiscard]] models::Contact contact_of(const schema::Recording& recording, std::size_t axis);

/// The law without the rendering aids of a BranchSelector (velocity filter, ramp band, reversal scaling):
/// what its tables say themselves.
[[nodiscard]] models::Law without_rendering_aids(const models::Law& law);

/// The force that a law gives along a series, tick by tick from a fresh state.
[[nodiscard]] std::vector<double> render(const models::Law& law, const AxisSeries& series);

}  // namespace kerf::bench
