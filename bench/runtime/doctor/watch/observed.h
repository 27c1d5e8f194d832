#pragma once

#include <optional>
#include <span>

#include "doctor/facts/finding.h"
#include "doctor/facts/host_tree.h"
#include "doctor/watch/watch.h"

namespace kerf::bench::doctor {

// What the run showed. Its cost is the longest lateness that came of it.

/// The longest lateness of one cause [us]; nothing if none was seen to come of it.
[[nodiscard]] std::optional<double> longest_us(std::span<const ExplainedWake> wakes, WakeCause cause);

/// Who else took the processors, by name, the loop's first.
[[nodiscard]] Finding other_processes(const HostTree& tree, const Watched& watched);
/// Interrupts of devices on the loop's processor.
[[nodiscard]] Finding interrupts(const HostTree& tree, const Watched& watched);
/// Whether irqbalance may bring more of them there.
[[nodiscard]] Finding irq_balance(const HostTree& tree, int processor);
/// What the kernel does of itself after interrupts.
[[nodiscard]] Finding softirqs(const Watched& watched);
/// What a hypervisor took of the loop's processor.
[[nodiscard]] Finding steal_time(const HostTree& tree, const Watched& watched);
/// All processors standing still at once: firmware, or the whole virtual machine.
[[nodiscard]] Finding standstill(const Watched& watched);
/// Pages that the loop's own thread had to wait for.
[[nodiscard]] Finding page_faults(const Watched& watched);
/// How many threads want to run, by the mean of the last minute.
[[nodiscard]] Finding load(const HostTree& tree);

}  // namespace kerf::bench::doctor
