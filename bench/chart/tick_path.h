#pragma once

#include <functional>
#include <vector>

#include <kerf/drivers/device.h>

#include "scene/scene.h"

namespace kerf::bench {

/// Where the tool is, tick by tick, on every axis of a device.
struct TickPath {
  double period_s = 0.0;
  std::vector<drivers::Axes> position;
  std::vector<drivers::Axes> velocity;
};

/// A way of the tool that can be had at any rate, and the device whose axes it is given on.
struct ScriptedPath {
  drivers::DeviceInfo device;
  std::function<TickPath(double rate_hz)> at;
};

/// The way of a scene's tool by script alone. @throws std::invalid_argument if no device fits the tissue.
[[nodiscard]] ScriptedPath scripted_path(const Scene& scene);

}  // namespace kerf::bench
