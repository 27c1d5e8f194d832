#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "doctor/facts/finding.h"
#include "doctor/facts/host_tree.h"
#include "doctor/facts/trials.h"

namespace kerf::bench::doctor {

// What this process may do.

/// A soft limit of /proc/self/limits, by the words that it begins with; -1: unlimited.
[[nodiscard]] std::optional<std::int64_t> limit_of(std::string_view limits, std::string_view name);
/// Whether a capability, by its number (capabilities(7)), is in the effective set of /proc/self/status.
[[nodiscard]] std::optional<bool> has_capability(std::string_view status, int number);

/// Whether SCHED_FIFO can be taken, by trying; with the limits and capabilities that decide it.
[[nodiscard]] Finding realtime_scheduling(const HostTree& tree, const MachineTrials& trials);
/// Whether the process's memory may be locked.
[[nodiscard]] Finding memory_lock(const HostTree& tree);
/// Whether the kernel takes the processor from real-time threads for a while, at the share of time that the
/// loop uses: 0 to 1, none if it was not measured.
[[nodiscard]] Finding realtime_throttling(const HostTree& tree, std::optional<double> loop_share);
/// How late timers wake a thread that asks for nothing.
[[nodiscard]] Finding timer_slack(const MachineTrials& trials);

}  // namespace kerf::bench::doctor
