#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/drivers/device.h>

#include "probe/probe_rendering.h"
#include "run/run.h"

namespace kerf::bench {

struct ProbeOptions {
  /// Told what will be pushed, once the device is open and before anything moves; it may wait for a person,
  /// and throw to give up.
  std::function<void(const drivers::DeviceInfo&, const std::vector<ProbedAxis>&)> before;
  ShowProgress progress = show_no_progress;
};

/// What pushes on a device have shown.
struct ProbeResult {
  drivers::DeviceInfo device;
  std::vector<ProbedAxis> axes;  ///< those with force
  bool finished = false;         ///< every axis was judged; else it was stopped, or disturbed for too long

  [[nodiscard]] bool all_right() const noexcept;
};

/// Pushes along each axis with force of a device and looks which way it moves: ProbeRendering, in the loop
/// with its Safety at 1 kHz; a simulated device with its hand in virtual time.
/// @throws as run_on_device(); std::invalid_argument: the device has no force.
[[nodiscard]] ProbeResult probe_device(const std::string& uri, const ProbeOptions& options,
                                       const std::atomic<bool>& stop);

[[nodiscard]] nlohmann::ordered_json probe_as_json(const ProbeResult& result);
/// A line for each axis: verdict, how far it moved for how much force, pushes.
[[nodiscard]] std::vector<std::string> probe_lines(const ProbeResult& result);

}  // namespace kerf::bench
