#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/drivers/device.h>
#include <kerf/identification/excitation.h>
#include <kerf/identification/identify.h>

#include "files/progress.h"
#include "identify/excitation_rendering.h"

namespace kerf::bench {

/// How an axis is to be excited.
struct ExperimentOptions {
  std::string device_uri;
  double force_n = 0.0;    ///< no force is larger, in the axis' unit; 0: a tenth of its limit
  double travel_m = 0.02;  ///< no motion is meant to be wider, and none may go farther from its place
  double seconds = 30.0;
  double period_s = 1.0;  ///< of the excitation; no frequency below 1 / period_s is excited
  bool held = false;
  std::size_t places = 1;  ///< whose constant force is told; in the hand one alone
  identification::ExcitationKind kind = identification::ExcitationKind::multisine;
  double lowest_hz = 1.0;
  double highest_hz = 40.0;
  bool virtual_time = false;
  std::uint64_t seed = 1;
  ShowProgress progress = show_no_progress;
  std::function<void(std::string_view)> warn;
};

/// What came of exciting one axis.
struct AxisExperiment {
  identification::Experiment experiment;
  identification::Design design;
  std::vector<double> places_m;
  ExperimentEnd end = ExperimentEnd::complete;
  std::string problem;  ///< why it ended early or was never begun, in one line; empty if it is whole
  drivers::DeviceInfo device;
};

/// Excites an axis: a pilot whose force doubles until the axis moves by a quarter of the travel, a design
/// from what that told, and the excitation itself; in the loop with its Safety at 1 kHz. `record`: where the
/// latter is recorded; empty: nowhere. What ended early holds the whole stretches so far.
/// @throws as run_on_device(); std::invalid_argument: the axis has no force, or a limit that allows none.
[[nodiscard]] AxisExperiment excite_axis(const ExperimentOptions& options, std::size_t axis,
                                         const std::filesystem::path& record, const std::atomic<bool>& stop);

/// Beside the recording: which ticks are which stretch, so that it can be estimated anew.
[[nodiscard]] nlohmann::ordered_json layout_as_json(const AxisExperiment& measured);
/// Both again. @throws std::invalid_argument, schema::FormatError
[[nodiscard]] AxisExperiment read_experiment(const std::filesystem::path& recording,
                                             const nlohmann::ordered_json& layout, std::size_t axis);

}  // namespace kerf::bench
