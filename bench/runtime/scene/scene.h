#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/hand.h>

#include "laws/law_file.h"
#include "laws/sampled_motion.h"
#include "scene/trajectory.h"

namespace kerf::bench {

/// A tissue under another one, along the same axis.
struct TissueLayer {
  LawFile law;        ///< its penetration counts from where the layer begins
  double from = 0.0;  ///< where it begins: penetration of the first layer's contact [unit of the axis]
  double until = std::numeric_limits<double>::infinity();  ///< past it the layer has been cut through
};

/// What a simulated tool meets, the device and the hand that hold the tool, and what they do with it.
/// docs/scenes.md has the file's format.
///
/// The tissue lies on one axis of the device, in one layer or several, or on those of a law that brings its
/// own (`blade` on sim:pose6). All layers resist together,
///
///     F = sum of F_i(x - from_i) over the layers that are not cut through,
///
/// and a layer is cut through once x reaches its `until`; when the tool has left the tissue (x <= 0) it meets
/// fresh tissue again, as scissors do that move on between two cuts.
struct Scene {
  std::string name;
  LawFile tissue;  ///< the first layer, with the contact
  double tissue_until = std::numeric_limits<double>::infinity();
  std::vector<TissueLayer> deeper{};
  std::string tool{};        ///< in words
  std::string device_uri{};  ///< of a simulated device; empty: not said
  drivers::HandImpedance hand = drivers::usual_grip;
  bool hand_given = false;  ///< there is a table [hand]
  Trajectory trajectory{};
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

/// The URI that the scene's device is opened with: its own, or the first simulated device that its tissue
/// fits, with hand and trajectory as options. @throws std::invalid_argument if no device fits the tissue.
[[nodiscard]] std::string device_of(const Scene& scene);

/// The tool's path by script alone, on every axis of the scene's device: where the hand would have the tool
/// if nothing resisted, and how fast. Strokes are taken without their variation.
/// @throws std::invalid_argument: a scene that says nothing of what the hand does, on a device that is not a
///         pair of scissors; a rate that is not from 1 Hz to 1 MHz; more than 20 million ticks.
[[nodiscard]] SampledMotion tool_path(const Scene& scene, double rate_hz);

}  // namespace kerf::bench
