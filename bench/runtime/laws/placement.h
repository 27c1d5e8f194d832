#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// The names of a device's axes, for messages: "theta, x_s".
[[nodiscard]] std::string names_of_axes(const drivers::DeviceInfo& device);

/// The axis of a device on which a law is rendered: the one it names, else the first with its units.
/// @throws std::invalid_argument if there is none, naming both units.
[[nodiscard]] std::size_t axis_for(const LawFile& law, const drivers::DeviceInfo& device);

/// The device's axis for every axis of a law: axis_for() a scalar law; for a spatial one those of the same
/// names.
/// @throws std::invalid_argument if the device lacks an axis, or has it in other units.
[[nodiscard]] std::vector<std::size_t> axes_for(const LawFile& law, const drivers::DeviceInfo& device);

}  // namespace kerf::bench
