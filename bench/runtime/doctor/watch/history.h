#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "doctor/facts/cgroups.h"
#include "doctor/facts/host_tree.h"
#include "doctor/watch/counters.h"
#include "doctor/watch/tasks.h"

namespace kerf::bench::doctor {

/// What the kernel had counted at a moment.
struct Moment {
  std::int64_t at_ns = 0;  ///< by the monotonic clock, before it was asked
  std::optional<ProcessorTimes> times;
  std::vector<Count> interrupts;  ///< of the loop's processor
  std::optional<Throttled> throttled;
};

/// What ran on the loop's processor between two scans of all threads.
struct TasksBetween {
  std::int64_t from_ns = 0;
  std::int64_t until_ns = 0;
  std::vector<Task> ran;  ///< the most first
};

/// What was seen beside a loop while it ran.
struct History {
  std::vector<Moment> moments;
  std::vector<TasksBetween> tasks;
  std::vector<Task> ran_anywhere;  ///< over the whole run, on all processors, the most first
  std::vector<Task> ran_beside;    ///< of these, who was seen on the loop's processor, with the time there
  std::vector<Count> softirqs;     ///< on the loop's processor, over the whole run
  double busiest_sibling =
      -1.0;  ///< share of time that a processor of the same core was at work; < 0: none is told
};

/// The counts of now.
[[nodiscard]] Moment look(const HostTree& tree, int processor);

/// Two tables of who ran, put together: the times of one thread are added.
void add_tasks(std::vector<Task>& all, const std::vector<Task>& more);

}  // namespace kerf::bench::doctor
