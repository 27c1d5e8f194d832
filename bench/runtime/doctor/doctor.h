#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "doctor/device_times.h"
#include "doctor/facts/finding.h"
#include "doctor/facts/host_tree.h"
#include "doctor/facts/trials.h"
#include "doctor/judgement.h"
#include "doctor/watch/watch.h"
#include "files/progress.h"

namespace kerf::bench::doctor {

struct DoctorOptions {
  std::string
      uri;  ///< of a device to look at as well; empty: those on the USB are looked at, and none is opened
  WatchOptions watch;
  HostTree tree;  ///< what the machine tells of itself
  ShowProgress progress = show_no_progress;
};

/// Whether a machine holds a rate, and what of it costs.
struct Diagnosis {
  RateJudgement judgement;
  Watched watched;
  MachineTrials trials;
  std::optional<DeviceTimes> device;
  std::vector<Finding> findings;  ///< sorted by cost
};

/// All that can be told of a machine by its files, by what was tried, and by a run that was watched.
/// `uri`: of the one device whose way over the USB is looked at; empty: of all that are attached.
[[nodiscard]] std::vector<Finding> findings_of(const HostTree& tree, const MachineTrials& trials,
                                               const Watched& watched,
                                               std::optional<std::int64_t> throttle_count_before,
                                               const std::string& uri);

/// Opens the device, if one is named, and times it; tries what this user may do; watches an empty loop; and
/// says what was found. `stop` ends both runs early: what they showed so far is judged.
/// @throws drivers::DeviceError, std::invalid_argument
[[nodiscard]] Diagnosis examine(const DoctorOptions& options, const std::atomic<bool>& stop);

/// The JSON of `kerf doctor`.
[[nodiscard]] nlohmann::ordered_json diagnosis_as_json(const Diagnosis& diagnosis);

/// Its lines for people, the verdict last.
[[nodiscard]] std::vector<std::string> diagnosis_lines(const Diagnosis& diagnosis);

}  // namespace kerf::bench::doctor
