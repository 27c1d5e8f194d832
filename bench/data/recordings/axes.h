#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

namespace kerf::bench {

/// The place of the axis with that name; an empty name means the first one.
/// @throws std::invalid_argument that lists the axes there are.
[[nodiscard]] std::size_t find_axis(const schema::Recording& recording, const std::string& name);

/// The same, but an empty name means the axis of the recording's cycles, where it has any.
[[nodiscard]] std::size_t find_cut_axis(const schema::Recording& recording, const std::string& name);

/// A device's axes, as a recording describes them.
[[nodiscard]] std::vector<schema::Axis> axes_of(const drivers::DeviceInfo& device);

}  // namespace kerf::bench
