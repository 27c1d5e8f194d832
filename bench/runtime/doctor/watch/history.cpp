#include "doctor/watch/history.h"

#include <algorithm>

#include <unistd.h>

#include "loop/clock.h"

namespace kerf::bench::doctor {

Moment look(const HostTree& tree, int processor) {
  Moment moment{.at_ns = WallClock::now_ns(), .times = {}, .interrupts = {}, .throttled = {}};
  if (const auto stat = tree.text("/proc/stat"))
    moment.times = processor_times(*stat, processor, sysconf(_SC_CLK_TCK));
  if (const auto interrupts = tree.text("/proc/interrupts"))
    moment.interrupts = interrupts_of(*interrupts, processor);
  moment.throttled = throttled_so_far(tree);
  return moment;
}

void add_tasks(std::vector<Task>& all, const std::vector<Task>& more) {
  for (const Task& task : more) {
    const auto same = std::ranges::find(all, task.tid, &Task::tid);
    if (same == all.end()) {
      all.push_back(task);
    } else {
      same->run_us += task.run_us;
    }
  }
  std::ranges::stable_sort(all, std::ranges::greater{}, &Task::run_us);
}

}  // namespace kerf::bench::doctor
