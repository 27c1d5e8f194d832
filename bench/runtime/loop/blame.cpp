#include "loop/blame.h"

#include <fmt/core.h>

namespace kerf::bench {
namespace {

Cause cause_of_computation(const Miss& miss, double period_ns) {
  const double allowed_ns = compute_share * period_ns * static_cast<double>(miss.periods);
  if (static_cast<double>(miss.least_cpu_ns) > allowed_ns) return Cause::law;
  if (static_cast<double>(miss.most_cpu_ns) > allowed_ns) return Cause::unknown;
  const bool waited_of_itself = miss.waited > 0 && miss.preempted == 0 && miss.disk_faults == 0;
  return waited_of_itself ? Cause::law : Cause::machine;
}

Cause cause_of_device(const Miss& miss) {
  if (miss.least_cpu_ns > miss.wall_ns / 2) return Cause::device;
  if (miss.disk_faults > 0) return Cause::machine;
  if (miss.waited > 0) return miss.preempted == 0 ? Cause::device : Cause::unknown;
  return miss.most_cpu_ns > miss.wall_ns / 2 ? Cause::unknown : Cause::machine;
}

}  // namespace

Cause cause_of(const Miss& miss, double period_ns) noexcept {
  if (miss.stood_still && miss.least_cpu_ns < miss.wall_ns / 2) return Cause::machine;
  switch (miss.stage) {
    case Stage::compute:
      return cause_of_computation(miss, period_ns);
    case Stage::read:
    case Stage::write:
      return cause_of_device(miss);
    case Stage::wake:
    case Stage::record:
      break;
  }
  return Cause::machine;
}

std::string in_words(const Miss& miss) {
  const auto ms = [](std::int64_t ns) { return 1e-6 * static_cast<double>(ns); };
  std::string text = fmt::format("tick {}: {} took {:.3g} ms", miss.tick,
                                 stage_names[static_cast<std::size_t>(miss.stage)], ms(miss.wall_ns));
  if (miss.stage != Stage::wake) {
    text += fmt::format(", {:.3g} to {:.3g} ms of the processor for {} period{}", ms(miss.least_cpu_ns),
                        ms(miss.most_cpu_ns), miss.periods, miss.periods == 1 ? "" : "s");
    text += fmt::format("; waited {} times, made to wait {} times", miss.waited, miss.preempted);
  }
  if (miss.disk_faults > 0) text += fmt::format("; {} pages read from a disk", miss.disk_faults);
  if (miss.stood_still) text += "; the whole process stood still";
  return text + fmt::format(": {}", cause_names[static_cast<std::size_t>(miss.cause)]);
}

}  // namespace kerf::bench
