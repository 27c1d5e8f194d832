#include "loop/loop.h"

namespace kerf::bench {

void LoopReport::count(const TickTimes& times, std::uint32_t flags) noexcept {
  for (std::size_t stage = 0; stage < stages.size(); ++stage) {
    stages[stage].add(times.duration_ns(static_cast<Stage>(stage)));
  }
  cycle.add(times.end_ns.back() - times.end_ns.front());
  ++executed;
  for (std::uint32_t rest = flags; rest != 0; rest &= rest - 1) {
    ++flagged[static_cast<std::size_t>(std::countr_zero(rest))];
  }
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
