#pragma once

#include <optional>
#include <string>

#include "doctor/facts/finding.h"
#include "doctor/facts/host_tree.h"
#include "doctor/facts/trials.h"

namespace kerf::bench::doctor {

// What the kernel is, how it was started, and on what.

/// What the time is read from; what it costs is one reading.
[[nodiscard]] Finding clock_source(const HostTree& tree, const MachineTrials& trials);

/// Whether there is a hypervisor below. `unexplained_us`: the longest lateness of the run for which nothing
/// within the machine was seen.
[[nodiscard]] Finding virtual_machine(const HostTree& tree, std::optional<double> unexplained_us);

/// A line of the kernel's configuration, "CONFIG_PREEMPT_NONE=y", by name: "y", "m" or its value, "n" where
/// it is not set; nothing where the configuration is not told. Of /boot/config-RELEASE or /proc/config.gz.
[[nodiscard]] std::optional<std::string> kernel_option(const HostTree& tree, const std::string& name);
/// Whether the kernel lets itself be interrupted: PREEMPT_RT bounds how late it wakes a loop.
[[nodiscard]] Finding preemption(const HostTree& tree);

/// Whether the loop's processor is kept free of others: isolcpus, nohz_full, rcu_nocbs, irqaffinity.
[[nodiscard]] Finding isolated_processor(const HostTree& tree, int processor);

/// Transparent huge pages: `always` lets page faults wait for the memory to be tidied up.
[[nodiscard]] Finding huge_pages(const HostTree& tree);
/// Whether memory can go to a disk. `is_locked`: the loop's memory stays where it is.
[[nodiscard]] Finding swap(const HostTree& tree, bool is_locked);
/// How much memory is left: where it is short everybody who asks for some waits.
[[nodiscard]] Finding memory_left(const HostTree& tree);

}  // namespace kerf::bench::doctor
