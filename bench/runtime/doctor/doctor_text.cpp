#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "doctor/doctor.h"

namespace kerf::bench::doctor {
namespace {

std::string percentiles_line(std::string_view name, const Percentiles& times, std::string_view missed) {
  return fmt::format("  {:10} {:9.1f} {:9.1f} {:9.1f} {:9.1f}  {}", name, times.p50_us, times.p99_us,
                     times.p999_us, times.max_us, missed);
}

void add_times(const Watched& watched, std::vector<std::string>& lines) {
  lines.push_back(fmt::format("  {:10} {:>9} {:>9} {:>9} {:>9}  {}", "late by us", "p50", "p99", "p99.9",
                              "max", "missed"));
  lines.push_back(percentiles_line("loop",
                                   percentiles_of(watched.loop.stages[static_cast<std::size_t>(Stage::wake)]),
                                   fmt::format("{} of {}", watched.loop.missed(), watched.loop.ticks())));
  lines.push_back(percentiles_line(
      "sleeper", percentiles_of(watched.sleeper.wake),
      fmt::format("{} of {}", watched.sleeper.missed, watched.sleeper.missed + watched.sleeper.ticks)));
}

/// How many late wake-ups came of what, and of the longest who.
void add_causes(const Watched& watched, std::vector<std::string>& lines) {
  if (watched.explained.empty()) {
    lines.push_back(fmt::format("  no wake-up was more than {:.0f} us late", watched.late_us));
    return;
  }
  lines.push_back(fmt::format("  {} wake-ups of both were more than {:.0f} us late:", watched.late_wakes,
                              watched.late_us));
  for (std::size_t cause = 0; cause < wake_cause_names.size(); ++cause) {
    const ExplainedWake* longest = nullptr;
    std::size_t count = 0;
    for (const ExplainedWake& one : watched.explained) {
      if (one.cause != static_cast<WakeCause>(cause)) continue;
      ++count;
      if (longest == nullptr || one.wake.late_ns() > longest->wake.late_ns()) longest = &one;
    }
    if (longest == nullptr) continue;
    lines.push_back(fmt::format("    {:6} {:12} up to {:.0f} us: {}", count, wake_cause_names[cause],
                                1e-3 * static_cast<double>(longest->wake.late_ns()), longest->by));
  }
}

void add_device(const DeviceTimes& device, std::vector<std::string>& lines) {
  lines.push_back(fmt::format("  {} in {} ticks, {} of them without an answer:", device.info.uri,
                              device.ticks, device.faults));
  lines.push_back(fmt::format("  {:10} {:>9} {:>9} {:>9} {:>9}", "us", "p50", "p99", "p99.9", "max"));
  lines.push_back(percentiles_line("read", device.read, ""));
  lines.push_back(percentiles_line("write", device.write, ""));
  lines.push_back(percentiles_line("report age", percentiles_of(device.age),
                                   fmt::format("jitter {:.1f} us", device.age_jitter_us())));
}

void add_finding(const Finding& finding, std::vector<std::string>& lines) {
  constexpr std::array<char, state_names.size()> marks{'+', '-', '?'};
  std::string cost;
  if (finding.cost.us) cost = fmt::format("{:.{}f} us", *finding.cost.us, *finding.cost.us < 1.0 ? 3 : 1);
  if (finding.state == State::good && !cost.empty()) cost = fmt::format("({})", cost);
  lines.push_back(fmt::format("  {} {:>13}  {}: {}", marks[static_cast<std::size_t>(finding.state)], cost,
                              finding.name, finding.seen));
  if (finding.state == State::good) return;
  if (finding.state == State::costs) lines.push_back(fmt::format("{:18}cost: {}", "", finding.cost.why));
  lines.push_back(fmt::format("{:18}from: {}", "", finding.where));
  if (!finding.mend.empty()) lines.push_back(fmt::format("{:18}mend: {}", "", finding.mend));
}

}  // namespace

std::vector<std::string> diagnosis_lines(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("An empty loop at {:.0f} Hz on processor {}, beside a thread that only sleeps:",
                              diagnosis.watched.rate_hz, diagnosis.watched.processor));
  add_times(diagnosis.watched, lines);
  add_causes(diagnosis.watched, lines);
  if (diagnosis.device) add_device(*diagnosis.device, lines);
  lines.emplace_back("What was looked at (- costs, ? unknown, + good, with what was measured in brackets):");
  for (const Finding& finding : diagnosis.findings) add_finding(finding, lines);
  lines.push_back(diagnosis.judgement.line);
  return lines;
}

}  // namespace kerf::bench::doctor
