#include "run/timed_sample.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

using Clock = SweepWorker::Clock;

constexpr std::uint64_t most_timed = 24;
constexpr double longest_s = 4.0;          // of the sample
constexpr double longest_begin_s = 300.0;  // of a worker, on a file system that is slow

double seconds_since(Clock::time_point time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

/// The most memory that a process had so far, as the kernel tells it.
std::uintmax_t peak_memory(pid_t process) {
  std::ifstream status(fmt::format("/proc/{}/status", process));
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  }
  return 0;
}

class Sample {
 public:
  Sample(const PlanFile& plan, const WorkerProgram& program, const std::atomic<bool>& stop)
      : plan_(&plan), worker_(program, plan.file), stop_(&stop) {}

  ExpectedCost take() {
    const Clock::time_point begun = Clock::now();
    if (!wait(longest_begin_s, [&] { return worker_.is_ready(); }))
      throw std::system_error(std::make_error_code(std::errc::no_child_process),
                              fmt::format("a worker does not begin: it {}", worker_.end()));
    cost_.begin_s = seconds_since(begun);
    const std::uint64_t cells = plan_->plan.cells();
    const std::uint64_t wanted = std::min(cells, most_timed);
    double sum_s = 0.0;
    const Clock::time_point ready = Clock::now();
    for (std::uint64_t i = 0; i < wanted && seconds_since(ready) < longest_s; ++i) {
      // The first once more: it reads what the others find read.
      if (i == 0 && !compute(0)) break;
      const std::uint64_t cell = (cells / wanted) * i + (cells / wanted) / 2;
      if (!compute(cell)) break;
      sum_s += last_s_;
      ++cost_.timed;
      cost_.longest_s = std::max(cost_.longest_s, last_s_);
      cost_.failed += last_failed_ ? 1 : 0;
    }
    if (cost_.timed > 0) cost_.cell_s = sum_s / static_cast<double>(cost_.timed);
    cost_.worker_bytes = peak_memory(worker_.process());
    return cost_;
  }

 private:
  /// @returns false if it takes too long.
  bool compute(std::uint64_t cell) {
    if (!worker_.order({.begin = cell, .end = cell + 1})) return false;
    return wait(std::min(plan_->plan.limits.seconds, 5.0 * longest_s), [&] { return worker_.is_idle(); });
  }

  template <typename Condition>
  bool wait(double most_s, const Condition& holds) {
    const Clock::time_point begun = Clock::now();
    while (!holds()) {
      if (*stop_)
        throw std::system_error(std::make_error_code(std::errc::interrupted), "the sample was stopped");
      if (seconds_since(begun) > most_s) return false;
      if (!processes::becomes_readable(worker_.descriptor(), 100)) continue;
      const bool lives = worker_.receive([&](const CellRecord& record, std::string_view) {
        if (const auto* const computed = std::get_if<ComputedCell>(&record)) last_s_ = computed->seconds;
        if (const auto* const failed = std::get_if<FailedCell>(&record)) last_s_ = failed->seconds;
        last_failed_ = std::holds_alternative<FailedCell>(record);
      });
      if (!lives) return false;
    }
    return true;
  }

  const PlanFile* plan_;
  SweepWorker worker_;
  const std::atomic<bool>* stop_;
  ExpectedCost cost_;
  double last_s_ = 0.0;
  bool last_failed_ = false;
};

}  // namespace

ExpectedCost timed_sample(const PlanFile& plan, const WorkerProgram& program, const std::atomic<bool>& stop) {
  return Sample(plan, program, stop).take();
}

std::uint64_t shards_for(const ExpectedCost& cost, std::uint64_t cells) {
  constexpr double shard_s = 1800.0;
  const double wanted = std::ceil(cost.whole_s(cells) / shard_s);
  return static_cast<std::uint64_t>(std::clamp(wanted, 1.0, std::min(1000.0, static_cast<double>(cells))));
}

}  // namespace kerf::bench
