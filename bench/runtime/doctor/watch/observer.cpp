#include "doctor/watch/observer.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <unistd.h>

#include "doctor/facts/processors.h"
#include "host/realtime.h"
#include "loop/clock.h"

namespace kerf::bench::doctor {
namespace {

constexpr std::int64_t look_each_ns = 20'000'000;
constexpr std::int64_t scan_each_ns = 250'000'000;

/// Counts over the whole run: at its beginning, and at its end.
struct Totals {
  std::vector<Count> softirqs;
  std::vector<std::pair<double, double>> siblings;  ///< idle and total time [us] of each
};

Totals totals(const HostTree& tree, int processor) {
  Totals now;
  now.softirqs = softirqs_of(tree.text("/proc/softirqs").value_or(""), processor);
  const std::string stat = tree.text("/proc/stat").value_or("");
  for (const int sibling : siblings_of(tree, processor)) {
    if (const auto times = processor_times(stat, sibling, sysconf(_SC_CLK_TCK)))
      now.siblings.emplace_back(times->idle_us, times->total_us);
  }
  return now;
}

double busiest(const Totals& before, const Totals& after) {
  double share = -1.0;
  for (std::size_t at = 0; at < std::min(before.siblings.size(), after.siblings.size()); ++at) {
    const double idle_us = after.siblings[at].first - before.siblings[at].first;
    const double total_us = after.siblings[at].second - before.siblings[at].second;
    if (total_us > 0.0) share = std::max(share, 1.0 - idle_us / total_us);
  }
  return share;
}

}  // namespace

MachineObserver::MachineObserver(const HostTree& tree, int processor, std::function<std::size_t()> late)
    : tree_(tree),
      processor_(processor),
      late_(std::move(late)),
      thread_([this](const std::stop_token& stop) { observe(stop); }) {}

History MachineObserver::end() {
  thread_.request_stop();
  thread_.join();
  return std::move(history_);
}

void MachineObserver::scan() {
  const std::int64_t from_ns = WallClock::now_ns();
  std::vector<Task> tasks = scan_tasks(tree_, getpid());
  const std::int64_t until_ns = WallClock::now_ns();
  if (last_scan_ns_ != 0) {
    std::vector<Task> ran = ran_between(last_tasks_, tasks);
    add_tasks(history_.ran_anywhere, ran);
    std::erase_if(ran, [&](const Task& task) { return task.processor != processor_; });
    add_tasks(history_.ran_beside, ran);
    history_.tasks.push_back({.from_ns = last_scan_ns_, .until_ns = until_ns, .ran = std::move(ran)});
  }
  last_tasks_ = std::move(tasks);
  last_scan_ns_ = from_ns;
  scan_took_ns_ = until_ns - from_ns;
}

void MachineObserver::observe(const std::stop_token& stop) {
  stay_off_loop_processor();
  const Totals before = totals(tree_, processor_);
  history_.moments.push_back(look(tree_, processor_));
  scan();
  std::size_t seen = late_();
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const std::size_t late = late_();
    const bool somebody_was_late = std::exchange(seen, late) != late;
    const std::int64_t now_ns = WallClock::now_ns();
    if (somebody_was_late || now_ns - history_.moments.back().at_ns >= look_each_ns)
      history_.moments.push_back(look(tree_, processor_));
    const std::int64_t pause_ns = somebody_was_late ? 0 : scan_each_ns;
    if (now_ns - last_scan_ns_ >= std::max(pause_ns, 10 * scan_took_ns_)) scan();
  }
  history_.moments.push_back(look(tree_, processor_));
  scan();
  const Totals after = totals(tree_, processor_);
  history_.softirqs = growth(before.softirqs, after.softirqs);
  history_.busiest_sibling = busiest(before, after);
}

}  // namespace kerf::bench::doctor
