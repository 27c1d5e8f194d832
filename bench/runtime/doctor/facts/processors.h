#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "doctor/facts/finding.h"
#include "doctor/facts/host_tree.h"
#include "doctor/facts/trials.h"

namespace kerf::bench::doctor {

// What a processor does by itself to a loop that stays on it.

/// How the processor's frequency is chosen; what it costs is a computation after a millisecond of sleep.
[[nodiscard]] Finding frequency_governor(const HostTree& tree, int processor, const MachineTrials& trials);
/// How deep the processor sleeps between ticks, and whether this user may hold that off.
[[nodiscard]] Finding idle_states(const HostTree& tree, int processor, const MachineTrials& trials);

/// The processors that share a core with one, without itself.
[[nodiscard]] std::vector<int> siblings_of(const HostTree& tree, int processor);
/// Whether another thread of the same core was at work. `busy`: the largest share of time that a sibling was,
/// over the run.
[[nodiscard]] Finding smt_siblings(const HostTree& tree, int processor, std::optional<double> busy);

/// How often the processors were slowed down for their heat since the start; nothing where nobody counts.
[[nodiscard]] std::optional<std::int64_t> thermal_throttle_count(const HostTree& tree);
/// By the counts before and after the run.
[[nodiscard]] Finding thermal_throttling(std::optional<std::int64_t> before,
                                         std::optional<std::int64_t> after);

}  // namespace kerf::bench::doctor
