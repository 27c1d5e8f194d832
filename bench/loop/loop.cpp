#include "loop/loop.h"

namespace kerf::bench {

void LoopReport::count(const TickTimes& times, std::uint32_t flags) noexcept {
  for (std::size_t stage = 0; stage < stages.size(); ++stage) {
    stages[stage].add(times.duration_ns(static_cast<Stage>(stage)));
  }
  cycle.add(times.end_ns.back() - times.end_ns.front());
  ++executed;
  law_faults += (flags & schema::flag_law_fault) != 0 ? 1U : 0U;
  device_faults += (flags & schema::flag_device_fault) != 0 ? 1U : 0U;
  limited += (flags & (schema::flag_force_limited | schema::flag_slew_limited)) != 0 ? 1U : 0U;
}

Stage longest_stage(const TickTimes& times, std::int64_t tick_deadline_ns) noexcept {
  auto longest = Stage::wake;
  std::int64_t longest_ns = times.end_ns.front() - tick_deadline_ns;
  for (const Stage stage : {Stage::read, Stage::compute, Stage::write, Stage::record}) {
    if (times.duration_ns(stage) <= longest_ns) continue;
    longest = stage;
    longest_ns = times.duration_ns(stage);
  }
  return longest;
}

}  // namespace kerf::bench
