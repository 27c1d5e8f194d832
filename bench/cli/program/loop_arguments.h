#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/verb.h"
#include "run/run.h"

namespace kerf::bench {

/// The options of a verb that runs the loop on a device.
struct LoopArguments {
  RunOptions options;
  std::string device;  ///< empty: the scene's, else sim:scissors
  std::string scene;
  std::optional<double> seconds;     ///< none: as long as the scene's trajectory, else RunOptions' own
  std::vector<std::string> changes;  ///< LAW@SECONDS
};

/// Adds --device, --scene, --sensor, --seconds, --rate, --virtual, --switch, --ramp, --passivity-control,
/// --device-model and --force; `scene_is` says what the verb does with a scene.
void add_loop_options(Verb& verb, LoopArguments& arguments, const std::string& scene_is);

/// What was asked for, with scene and the laws of --switch read. A scene also gives the device, with its hand
/// and trajectory, unless there is a --device; what of the scene is then left out is warned of in one line.
/// @throws std::invalid_argument, std::system_error
[[nodiscard]] RunOptions run_options(const LoopArguments& arguments);

}  // namespace kerf::bench
