#pragma once

#include <filesystem>
#include <string>

#include <kerf/drivers/device.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// What a simulated tool meets: a tissue with known parameters, on one axis of the device, or on those of a
/// law that brings its own (`blade` on sim:pose6).
///
///     name = "skin-like"
///     [tissue]            # as a law file: model, axis, position_unit, force_unit
///     [tissue.contact]
///     [tissue.parameters]
///     [tissue.fidelity]
struct Scene {
  std::string name;
  LawFile tissue;
  std::string toml;  ///< as it was read, for the recording
};

/// @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file);
[[nodiscard]] Scene parse_scene(const std::string& text, const std::string& name);

/// The scene that a simulated device has if none is given: a Kelvin tissue between the blades of scissors.
[[nodiscard]] Scene default_scene();

/// The tissue as a simulated device calls it. @throws std::invalid_argument if the device has no such axis,
/// or one of other units.
[[nodiscard]] drivers::Surroundings surroundings_of(const Scene& scene, const drivers::DeviceInfo& device);

}  // namespace kerf::bench
