#include "run/check_text.h"

#include <fmt/core.h>

namespace kerf::bench {
namespace {

std::string times_of(std::string_view name, const Histogram& times) {
  const auto percentile_us = [&](double share) { return 1e-3 * times.percentile_ns(share); };
  return fmt::format("  {:11} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f}", name, 1e-3 * times.mean_ns(),
                     percentile_us(0.5), percentile_us(0.99), percentile_us(0.999), 1e-3 * times.max_ns());
}

void add_times(const LoopReport& report, std::vector<std::string>& lines) {
  lines.push_back(fmt::format("  {:11} {:>9} {:>9} {:>9} {:>9} {:>9}  {:>7}", "us", "mean", "p50", "p99",
                              "p99.9", "max", "missed"));
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
    lines.push_back(times_of(stage_names[stage], report.stages[stage]) +
                    fmt::format("{:9}", report.missed_by[stage]));
    if (static_cast<Stage>(stage) == Stage::compute)
      lines.push_back(times_of("compute_cpu", report.compute_cpu));
  }
  lines.push_back(times_of("cycle", report.cycle));
}

}  // namespace

std::vector<std::string> check_lines(const RunResult& result, const Verdict& verdict) {
  std::vector<std::string> lines;
  for (const RealtimeMeasure& measure : result.realtime)
    lines.push_back(fmt::format("  {} {}: {}", measure.obtained ? "+" : "-", measure.name, measure.detail));
  add_times(result.report, lines);
  if (const auto& floor = result.floor) {
    lines.push_back(
        fmt::format("  an empty loop here: woken {:.1f} us late at the median, {:.1f} us at 99.9 %, {:.0f} "
                    "us at worst; {} "
                    "of {} deadlines missed (measured {})",
                    floor->wake.p50_us, floor->wake.p999_us, floor->wake.max_us, floor->missed, floor->ticks,
                    floor->measured));
  }
  if (!result.realtime.empty()) {
    lines.push_back(fmt::format(
        "  {} page faults and {} involuntary context switches in the loop; it spins for {:.0f} us",
        result.usage.page_faults + result.usage.major_page_faults, result.usage.involuntary_switches,
        1e-3 * static_cast<double>(result.spin_ns)));
  }
  for (const std::string& reason : verdict.reasons) lines.push_back("  " + reason);
  return lines;
}

}  // namespace kerf::bench
