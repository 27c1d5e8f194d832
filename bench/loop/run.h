#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "laws/law_file.h"
#include "loop/loop.h"
#include "loop/realtime.h"
#include "scene/scene.h"

namespace kerf::bench {

/// What to run on a device, for how long, and where to record it.
struct RunOptions {
  std::string device_uri = "sim:scissors";
  double seconds = 10.0;
  double rate_hz = 1000.0;
  bool virtual_time = false;
  std::optional<LawFile> law;                   ///< rendered as force; none: the device moves freely
  std::optional<Scene> scene;                   ///< what a simulated device meets
  std::optional<std::filesystem::path> record;  ///< where to record
  bool replace = false;                         ///< an existing recording may be replaced
};

struct RunResult {
  drivers::DeviceInfo device;
  double period_s = 0.0;
  LoopReport report;
  std::vector<RealtimeMeasure> realtime;  ///< empty in virtual time
  std::uint64_t rows_lost = 0;
};

/// Runs the loop on a device and records it if asked to. `stop` ends it early and cleanly.
/// @throws drivers::DeviceError, std::invalid_argument, std::system_error (the recording could not be
/// written).
[[nodiscard]] RunResult run_on_device(const RunOptions& options, const std::atomic<bool>& stop);

/// A flag that Ctrl-C and SIGTERM set while the object lives.
class StopOnSignal {
 public:
  StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
  ~StopOnSignal();
  [[nodiscard]] const std::atomic<bool>& requested() const noexcept;
};

}  // namespace kerf::bench
