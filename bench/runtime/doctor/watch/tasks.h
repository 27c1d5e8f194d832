#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doctor/facts/host_tree.h"

namespace kerf::bench::doctor {

/// A thread of any process, as /proc shows it.
struct Task {
  std::int64_t pid = 0;
  std::int64_t tid = 0;
  std::string name;
  int processor = -1;            ///< that it ran on last
  std::int64_t rt_priority = 0;  ///< 0: ordinary scheduling
  double run_us = 0.0;           ///< time on processors since it began
};

/// A line of /proc/PID/task/TID/stat; times in clock ticks of so many a second. Nothing if it is none.
[[nodiscard]] std::optional<Task> task_of(std::string_view stat, std::int64_t ticks_per_s);

/// All threads, by their number, without those of the process `but`. Those that came and went between two
/// scans are in neither.
[[nodiscard]] std::vector<Task> scan_tasks(const HostTree& tree, std::int64_t but);

/// What ran between two scans: `run_us` is by how much it grew. The most first; who did not run is left out.
[[nodiscard]] std::vector<Task> ran_between(const std::vector<Task>& before, const std::vector<Task>& after);

/// "stress (4211)", with "at real-time priority 99" where it has one.
[[nodiscard]] std::string in_words(const Task& task);

}  // namespace kerf::bench::doctor
