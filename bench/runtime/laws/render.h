#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

#include "laws/law_file.h"
#include "laws/sampled_motion.h"
#include "recordings/axis_series.h"

namespace kerf::bench {

/// The contact of a recording: that of the tissue in its scene if it was simulated, else the onset that
/// `kerf prepare` found, else from its cycles if it was segmented, else the smallest position with direction
/// +1, but for single rows that jump there and back.
[[nodiscard]] models::Contact contact_of(const schema::Recording& recording, std::size_t axis);

/// The law without the rendering aids of a BranchSelector (velocity filter, ramp band, reversal scaling):
/// what its tables say themselves.
[[nodiscard]] models::Law without_rendering_aids(const models::Law& law);

/// The resisting force that a law along one axis gives along a series, tick by tick from a fresh state.
[[nodiscard]] std::vector<double> render(const models::Law& law, const AxisSeries& series);

/// What the loop commands along a motion, tick by tick, before any safety.
struct RenderedMotion {
  std::vector<drivers::Axes> force;
  std::size_t faults = 0;  ///< ticks in which the law gave no finite force
  std::optional<std::size_t> first_fault;
};

/// What LawRendering gives along a motion from a fresh state; `axes` as there.
[[nodiscard]] RenderedMotion render(const LawFile& law, const std::vector<std::size_t>& axes,
                                    const SampledMotion& motion);

}  // namespace kerf::bench
