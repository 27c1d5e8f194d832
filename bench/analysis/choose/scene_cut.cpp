#include "choose/scene_cut.h"

#include <stdexcept>

#include <fmt/core.h>

#include "laws/placement.h"
#include "run/run.h"
#include "segment/segment.h"

namespace kerf::bench {

schema::Recording record_scene(const Scene& scene, const SceneCut& cut, const std::filesystem::path& file,
                               const std::atomic<bool>& stop) {
  std::string uri = cut.device_uri.empty() ? device_of(scene) : cut.device_uri;
  if (uri.find("seed=") == std::string::npos)
    uri += fmt::format("{}seed={}", uri.find('?') == std::string::npos ? '?' : '&', cut.seed);
  const RunResult run = run_on_device({.device_uri = uri,
                                       .seconds = cut.seconds > 0.0 ? cut.seconds : scene.trajectory.seconds,
                                       .virtual_time = true,
                                       .scene = scene,
                                       .record = file,
                                       .replace = true},
                                      stop);
  schema::Recording recording = schema::read_recording(file);
  try {
    recording.cycles = find_cycles(recording, {.axis = axis_for(scene.tissue, run.device)});
  } catch (const std::invalid_argument&) {
    return recording;  // no cycles: a press and hold, or less than a stroke
  }
  schema::write_recording(file, recording, schema::Existing::replace);
  return recording;
}

}  // namespace kerf::bench
