#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "doctor/facts/finding.h"
#include "doctor/facts/host_tree.h"

namespace kerf::bench::doctor {

// How much of the processors this process is given.

/// The control groups that bound the processor time of this process, its own first: folders of version 1's
/// controller `cpu`, or of version 2.
[[nodiscard]] std::vector<std::string> cpu_groups(const HostTree& tree);

/// What of the processors' time the control group of this process is refused, so far.
struct Throttled {
  std::int64_t times = 0;
  double us = 0.0;
};
/// Of the group and those above it; nothing where none has a quota to count for.
[[nodiscard]] std::optional<Throttled> throttled_so_far(const HostTree& tree);
/// Whether the group or one above it has a quota of processor time. `during`: what it was refused in the run.
[[nodiscard]] Finding cgroup_quota(const HostTree& tree, const std::optional<Throttled>& during);
/// How many of the processors this process may use.
[[nodiscard]] Finding cpuset(const HostTree& tree);

}  // namespace kerf::bench::doctor
