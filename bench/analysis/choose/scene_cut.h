#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

#include <kerf/schema/recording.h>

#include "scene/scene.h"

namespace kerf::bench {

struct SceneCut {
  std::string device_uri;  ///< empty: the scene's
  double seconds = 0.0;    ///< 0: as long as the scene's trajectory
  std::uint64_t seed = 1;  ///< of the device, unless its URI has one
};

/// Records what a simulated device meets in a scene, in virtual time, to a file, which is replaced. Cycles
/// are found along the tissue's axis where there are some.
/// @throws drivers::DeviceError, std::invalid_argument, std::system_error.
[[nodiscard]] schema::Recording record_scene(const Scene& scene, const SceneCut& cut,
                                             const std::filesystem::path& file,
                                             const std::atomic<bool>& stop);

}  // namespace kerf::bench
