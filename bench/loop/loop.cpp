#include "loop/loop.h"

namespace kerf::bench {

std::uint64_t account(LoopReport& report, const Command& command, const std::array<std::int64_t, 5>& end_ns,
                      const GridPlace& place) noexcept {
  const std::int64_t deadline_ns = place.start_ns + static_cast<std::int64_t>(place.tick) * place.period_ns;
  std::array<std::int64_t, 5> duration_ns{end_ns[0] - deadline_ns};
  for (std::size_t stage = 1; stage < duration_ns.size(); ++stage)
    duration_ns[stage] = end_ns[stage] - end_ns[stage - 1];
  for (std::size_t stage = 0; stage < duration_ns.size(); ++stage)
    report.stages[stage].add(duration_ns[stage]);
  report.cycle.add(end_ns[4] - end_ns[0]);
  ++report.executed;
  report.law_faults += (command.flags & schema::flag_law_fault) != 0 ? 1U : 0U;
  report.device_faults += (command.flags & schema::flag_device_fault) != 0 ? 1U : 0U;
  report.limited += (command.flags & (schema::flag_force_limited | schema::flag_slew_limited)) != 0 ? 1U : 0U;

  if (end_ns[4] <= deadline_ns + place.period_ns) return place.tick + 1;
  const auto latest = static_cast<std::uint64_t>((end_ns[4] - place.start_ns) / place.period_ns);
  const std::uint64_t next = std::clamp(latest, place.tick + 1, std::max(place.ticks, place.tick + 1));
  const auto longest = std::max_element(duration_ns.begin(), duration_ns.end()) - duration_ns.begin();
  const std::uint64_t skipped = next - place.tick - 1;
  report.skipped += skipped;
  report.missed_by[static_cast<std::size_t>(longest)] += 1 + skipped;
  return next;
}

}  // namespace kerf::bench
