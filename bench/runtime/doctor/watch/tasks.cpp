#include "doctor/watch/tasks.h"

#include <algorithm>

#include <fmt/core.h>
#include <unistd.h>

namespace kerf::bench::doctor {

std::optional<Task> task_of(std::string_view stat, std::int64_t ticks_per_s) {
  // The name stands in parentheses and may hold any of them, and blanks.
  const auto open = stat.find('(');
  const auto close = stat.rfind(')');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return std::nullopt;
  const auto number = words_of(stat.substr(0, open));
  const auto words = words_of(stat.substr(close + 1));
  // As proc(5) numbers them; the first after the name is field 3.
  constexpr std::size_t first = 3;
  constexpr std::size_t utime = 14 - first;
  constexpr std::size_t stime = 15 - first;
  constexpr std::size_t processor = 39 - first;
  constexpr std::size_t rt_priority = 40 - first;
  if (number.size() != 1 || words.size() <= rt_priority) return std::nullopt;
  const auto field = [&](std::size_t at) { return number_of(words[at]).value_or(0); };
  return Task{
      .pid = number_of(number.front()).value_or(0),
      .tid = number_of(number.front()).value_or(0),
      .name = std::string(stat.substr(open + 1, close - open - 1)),
      .processor = static_cast<int>(field(processor)),
      .rt_priority = field(rt_priority),
      .run_us = 1e6 * static_cast<double>(field(utime) + field(stime)) / static_cast<double>(ticks_per_s)};
}

std::vector<Task> scan_tasks(const HostTree& tree, std::int64_t but) {
  const std::int64_t ticks_per_s = sysconf(_SC_CLK_TCK);
  std::vector<Task> tasks;
  for (const std::string& process : tree.names("/proc")) {
    const auto pid = number_of(process);
    if (!pid || *pid == but) continue;
    const std::string folder = fmt::format("/proc/{}/task", process);
    for (const std::string& thread : tree.names(folder)) {
      auto task = task_of(tree.text(fmt::format("{}/{}/stat", folder, thread)).value_or(""), ticks_per_s);
      if (!task) continue;  // it has ended meanwhile
      task->pid = *pid;
      // In nanoseconds, where the kernel counts them.
      if (const auto ran_ns = tree.number(fmt::format("{}/{}/schedstat", folder, thread)))
        task->run_us = 1e-3 * static_cast<double>(*ran_ns);
      tasks.push_back(std::move(*task));
    }
  }
  std::ranges::sort(tasks, {}, &Task::tid);
  return tasks;
}

std::vector<Task> ran_between(const std::vector<Task>& before, const std::vector<Task>& after) {
  std::vector<Task> ran;
  for (const Task& now : after) {
    const auto then = std::ranges::lower_bound(before, now.tid, {}, &Task::tid);
    const bool was_there = then != before.end() && then->tid == now.tid && then->run_us <= now.run_us;
    Task grown = now;
    if (was_there) grown.run_us -= then->run_us;
    if (grown.run_us > 0.0) ran.push_back(std::move(grown));
  }
  std::ranges::stable_sort(ran, std::ranges::greater{}, &Task::run_us);
  return ran;
}

std::string in_words(const Task& task) {
  return fmt::format("{} ({}){}", task.name, task.pid,
                     task.rt_priority > 0 ? fmt::format(" at real-time priority {}", task.rt_priority) : "");
}

}  // namespace kerf::bench::doctor
