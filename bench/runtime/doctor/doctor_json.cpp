#include <algorithm>
#include <string>

#include "doctor/doctor.h"
#include "run/check.h"

namespace kerf::bench::doctor {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t most_listed = 64;

json percentiles_as_json(const Percentiles& percentiles) {
  return {{"p50", percentiles.p50_us},
          {"p99", percentiles.p99_us},
          {"p999", percentiles.p999_us},
          {"max", percentiles.max_us}};
}

/// How many late wake-ups of loop or sleeper came of each cause.
json causes_of(const Watched& watched, bool is_loop) {
  json causes = json::object();
  for (std::size_t cause = 0; cause < wake_cause_names.size(); ++cause) {
    causes[wake_cause_names[cause]] = std::ranges::count_if(watched.explained, [&](const ExplainedWake& one) {
      return one.wake.is_loop == is_loop && one.cause == static_cast<WakeCause>(cause);
    });
  }
  return causes;
}

json wake_as_json(const ExplainedWake& one, std::int64_t from_ns) {
  json told{{"at_s", 1e-9 * static_cast<double>(one.wake.due_ns - from_ns)},
            {"of", one.wake.is_loop ? "loop" : "sleeper"},
            {"late_us", 1e-3 * static_cast<double>(one.wake.late_ns())},
            {"waited_us", nullptr},
            {"preempted", one.wake.usage.involuntary_switches},
            {"page_faults", one.wake.usage.page_faults},
            {"disk_faults", one.wake.usage.major_page_faults},
            {"cause", wake_cause_names[static_cast<std::size_t>(one.cause)]},
            {"by", one.by},
            {"pid", nullptr}};
  if (one.pid != 0) told["pid"] = one.pid;
  if (one.wake.run_delay_ns >= 0) told["waited_us"] = 1e-3 * static_cast<double>(one.wake.run_delay_ns);
  return told;
}

json loop_as_json(const Watched& watched, const RateJudgement& judgement) {
  return {{"ticks", watched.loop.ticks()},
          {"missed", watched.loop.missed()},
          {"missed_share", judgement.missed_share},
          {"missed_share_95", {judgement.lower_share, judgement.upper_share}},
          {"wake_us",
           percentiles_as_json(percentiles_of(watched.loop.stages[static_cast<std::size_t>(Stage::wake)]))},
          {"spin_us", 1e-3 * static_cast<double>(watched.spin_ns)},
          {"cpu_share", watched.cpu_share},
          {"late", causes_of(watched, true)}};
}

json sleeper_as_json(const Watched& watched) {
  const Sleeper& sleeper = watched.sleeper;
  const auto all = static_cast<double>(sleeper.ticks + sleeper.missed);
  return {{"ticks", sleeper.ticks + sleeper.missed},
          {"missed", sleeper.missed},
          {"missed_share", all > 0.0 ? static_cast<double>(sleeper.missed) / all : 0.0},
          {"wake_us", percentiles_as_json(percentiles_of(sleeper.wake))},
          {"late", causes_of(watched, false)}};
}

json device_as_json(const DeviceTimes& device) {
  return {{"uri", device.info.uri},
          {"ticks", device.ticks},
          {"missed", device.missed},
          {"faults", device.faults},
          {"read_us", percentiles_as_json(device.read)},
          {"write_us", percentiles_as_json(device.write)},
          {"report_age_us", percentiles_as_json(percentiles_of(device.age))},
          {"report_jitter_us", device.age_jitter_us()},
          {"figures", figures_as_json(device.figures)}};
}

}  // namespace

json diagnosis_as_json(const Diagnosis& diagnosis) {
  const Watched& watched = diagnosis.watched;
  json told{{"verdict", holds_names[static_cast<std::size_t>(diagnosis.judgement.holds)]},
            {"line", diagnosis.judgement.line},
            {"rate_hz", watched.rate_hz},
            {"processor", watched.processor},
            {"stopped", watched.loop.end == LoopEnd::stopped},
            {"loop", loop_as_json(watched, diagnosis.judgement)},
            {"sleeper", sleeper_as_json(watched)},
            {"late_from_us", watched.late_us},
            {"late_wakes", diagnosis.judgement.late},
            {"late_wakes_explained", diagnosis.judgement.explained}};
  const std::int64_t from_ns = watched.history.moments.empty() ? 0 : watched.history.moments.front().at_ns;
  told["latest"] = json::array();
  auto latest = watched.explained;
  std::ranges::stable_sort(latest, std::ranges::greater{},
                           [](const ExplainedWake& one) { return one.wake.late_ns(); });
  for (std::size_t at = 0; at < std::min(most_listed, latest.size()); ++at)
    told["latest"].push_back(wake_as_json(latest[at], from_ns));
  told["device"] = diagnosis.device ? device_as_json(*diagnosis.device) : json(nullptr);
  told["findings"] = json::array();
  for (const Finding& finding : diagnosis.findings) told["findings"].push_back(to_json(finding));
  return told;
}

}  // namespace kerf::bench::doctor
