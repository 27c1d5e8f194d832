#include <cmath>
#include <optional>
#include <stdexcept>

#include "fuzz/target.h"
#include "scene/scene.h"

namespace kerf::fuzz {
namespace {

/// A scene that is read has a device that takes it, and a tool whose path, if it has one, is finite.
void fuzz_scene(Bytes bytes) {
  std::optional<bench::Scene> scene;
  const std::string text(text_of(bytes));
  if (!is_taken<std::invalid_argument>([&] { scene = bench::parse_scene(text, "fuzz"); })) return;
  std::string uri;
  if (!is_taken<std::invalid_argument>([&] { uri = bench::device_of(*scene); })) {
    promise(scene->device_uri.empty(), "a scene that names its device is read with it");
    return;
  }
  bench::SampledMotion path;
  if (!is_taken<std::invalid_argument>([&] { path = bench::tool_path(*scene, 10.0); })) return;
  for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
    for (const auto* values : {&path.sample[tick].position, &path.sample[tick].velocity}) {
      for (const double value : *values) promise(std::isfinite(value), "the tool moves by finite numbers");
    }
  }
}

const Registered registered("scene", fuzz_scene);

}  // namespace
}  // namespace kerf::fuzz
