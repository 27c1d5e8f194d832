#include "run/check.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double passive_within_j = 1e-3;  ///< energy that quantised positions may feign

double to_us(double nanoseconds) { return 1e-3 * nanoseconds; }

nlohmann::ordered_json to_json(const Histogram& histogram) {
  return {{"mean", to_us(histogram.mean_ns())},
          {"p50", to_us(histogram.percentile_ns(0.5))},
          {"p99", to_us(histogram.percentile_ns(0.99))},
          {"p999", to_us(histogram.percentile_ns(0.999))},
          {"max", to_us(histogram.max_ns())}};
}

nlohmann::ordered_json to_json(const Miss& miss) {
  const auto us = [](std::int64_t ns) { return to_us(static_cast<double>(ns)); };
  return {{"tick", miss.tick},
          {"deadlines", miss.deadlines},
          {"stage", stage_names[static_cast<std::size_t>(miss.stage)]},
          {"wall_us", us(miss.wall_ns)},
          {"cpu_us", {us(miss.least_cpu_ns), us(miss.most_cpu_ns)}},
          {"periods", miss.periods},
          {"waited", miss.waited},
          {"preempted", miss.preempted},
          {"disk_faults", miss.disk_faults},
          {"stood_still", miss.stood_still},
          {"cause", cause_names[static_cast<std::size_t>(miss.cause)]}};
}

/// In seconds; null: nobody released the device.
nlohmann::ordered_json to_json(const Stall& stall) {
  const auto seconds = [](std::int64_t ns) { return 1e-9 * static_cast<double>(ns); };
  nlohmann::ordered_json told{{"from_s", seconds(stall.from_ns)}, {"silent_s", seconds(stall.silent_ns)}};
  told["released_after_s"] = nullptr;
  told["suspended"] = stall.suspended;
  if (stall.released_after_ns != 0) told["released_after_s"] = seconds(stall.released_after_ns);
  return told;
}

std::string_view meaning_of(schema::Flag flag) {
  return std::ranges::find(schema::flag_table, flag, &schema::FlagInfo::flag)->meaning;
}

/// The buckets from the first to the last that is not empty: one more edge than counts.
nlohmann::ordered_json buckets_of(const Histogram& histogram) {
  std::size_t first = 0;
  std::size_t end = Histogram::bucket_count;
  while (first < end && histogram.count_in(first) == 0) ++first;
  while (end > first && histogram.count_in(end - 1) == 0) --end;
  nlohmann::ordered_json edges = nlohmann::ordered_json::array();
  nlohmann::ordered_json counts = nlohmann::ordered_json::array();
  if (first < end) edges.push_back(first > 0 ? to_us(Histogram::upper_edge_ns(first - 1)) : 0.0);
  for (std::size_t bucket = first; bucket < end; ++bucket) {
    edges.push_back(to_us(Histogram::upper_edge_ns(bucket)));
    counts.push_back(histogram.count_in(bucket));
  }
  return {{"edges", edges}, {"counts", counts}};
}

std::uint64_t missed_by(const LoopReport& report, Stage stage) {
  return report.missed_by[static_cast<std::size_t>(stage)];
}

/// The law's own time: of the processor, not of the clock on the wall.
bool is_slow(const LoopReport& report, double period_ns) {
  return report.compute_cpu.percentile_ns(0.999) > compute_share * period_ns;
}

/// Who cost most of the deadlines.
Cause blame_for(const LoopReport& report) {
  const auto worst = std::ranges::max_element(report.missed_because) - report.missed_because.begin();
  return static_cast<Cause>(worst);
}

/// Missed deadlines beside those of an empty loop.
std::string beside_the_floor(const LoopReport& report, const HostFloor& floor) {
  const double share = static_cast<double>(floor.missed) / static_cast<double>(floor.ticks);
  const std::string empty = fmt::format("an empty loop missed {} of {} here", floor.missed, floor.ticks);
  if (report.missed() == 0) {
    if (floor.missed == 0) return "";
    return fmt::format("no deadline was missed in this run, but {}: expect {:.3g} in a minute", empty,
                       share * floor.rate_hz * 60.0);
  }
  if (static_cast<double>(report.missed()) <= floor.max_expected(report.ticks())) {
    return empty + ": these may all be the machine's own";
  }
  if (missed_by(report, Stage::wake) == report.missed()) {
    return empty + " when it was measured: the machine was later in this run; --floor measures it anew";
  }
  return empty + ": these are more than the machine's own";
}

std::string in_words(const LoopReport& report) {
  std::string text = fmt::format("{} of {} deadlines missed:", report.missed(), report.ticks());
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
    if (report.missed_by[stage] > 0)
      text += fmt::format(" {} by {}", report.missed_by[stage], stage_names[stage]);
  }
  text += "; because of";
  for (std::size_t cause = 0; cause < cause_names.size(); ++cause) {
    if (report.missed_because[cause] == 0) continue;
    text += fmt::format(" the {} {}", cause_names[cause], report.missed_because[cause]);
    if (static_cast<Cause>(cause) == Cause::machine && missed_by(report, Stage::wake) > 0)
      text += " (it woke the loop late, or made it wait)";
  }
  return text;
}

}  // namespace

Verdict judge(const RunResult& result) {
  const LoopReport& report = result.report;
  Verdict verdict;
  const auto fail = [&](Cause cause, std::string reason) {
    verdict.passed = false;
    verdict.causes.insert(cause);
    verdict.reasons.push_back(std::move(reason));
  };
  const auto tell = [&](std::string reason) {
    if (!reason.empty()) verdict.reasons.push_back(std::move(reason));
  };
  const double period_ns = 1e9 * result.period_s;
  const double cpu_ns = report.compute_cpu.percentile_ns(0.999);
  const double wall_ns = report.stages[static_cast<std::size_t>(Stage::compute)].percentile_ns(0.999);
  if (is_slow(report, period_ns)) {
    fail(Cause::law,
         fmt::format(
             "your law is too slow: 99.9 % of its ticks take up to {:.1f} us of processor time a period, of "
             "{:.0f} us that may be half used",
             to_us(cpu_ns), to_us(period_ns)));
  } else if (wall_ns > compute_share * period_ns) {
    tell(
        fmt::format("computations took up to {:.1f} us by the clock, but {:.1f} us of processor time: your "
                    "machine was late, not your law slow",
                    to_us(wall_ns), to_us(cpu_ns)));
  }
  if (report.missed() > 0) {
    if (static_cast<double>(report.missed()) > most_missed_share * static_cast<double>(report.ticks())) {
      fail(blame_for(report), in_words(report));
    } else {
      tell(in_words(report));
    }
    const auto misses = report.first_misses();
    const auto example = std::ranges::find(misses, blame_for(report), &Miss::cause);
    if (example != misses.end()) tell("for example " + in_words(*example));
  }
  if (result.floor) tell(beside_the_floor(report, *result.floor));
  for (const auto& [flag, cause] :
       {std::pair{schema::flag_law_fault, Cause::law}, std::pair{schema::flag_device_fault, Cause::device},
        std::pair{schema::flag_position_jump, Cause::device},
        std::pair{schema::flag_zero_held, Cause::device}}) {
    const std::uint64_t ticks = report.ticks_with(flag);
    if (ticks > 0) fail(cause, fmt::format("in {} ticks {}", ticks, meaning_of(flag)));
  }
  for (const schema::Flag flag : {schema::flag_watchdog, schema::flag_force_limited,
                                  schema::flag_slew_limited, schema::flag_passivity_control}) {
    const std::uint64_t ticks = report.ticks_with(flag);
    if (ticks > 0) tell(fmt::format("in {} ticks {}", ticks, meaning_of(flag)));
  }
  if (report.least_energy_j < -passive_within_j) {
    tell(fmt::format("the rendering gave up to {:.3g} J more than it took: not passive",
                     -report.least_energy_j));
  }
  if (report.end == LoopEnd::stopped) verdict.reasons.emplace_back("ended early by a signal");
  if (!result.recording_failure.empty()) tell(result.recording_failure);
  return verdict;
}

Verdict judge_law(const RunResult& result) {
  Verdict verdict = judge(result);
  verdict.felt = result.report.pushing > 0;
  if (verdict.felt) return verdict;
  verdict.passed = false;
  verdict.reasons.insert(verdict.reasons.begin(),
                         fmt::format("the law was never felt: its force was zero in all {} ticks, so that "
                                     "nothing was shown of it; is its contact where the tool goes?",
                                     result.report.executed));
  return verdict;
}

std::string_view name_of(const Verdict& verdict) {
  if (verdict.passed) return "pass";
  return verdict.felt || !verdict.causes.empty() ? "fail" : not_felt;
}

nlohmann::ordered_json figures_as_json(const std::vector<drivers::Figure>& figures) {
  auto json = nlohmann::ordered_json::object();
  for (const drivers::Figure& figure : figures) {
    json[figure.name] = {{"value", figure.value}, {"unit", figure.unit}};
  }
  return json;
}

nlohmann::ordered_json check_as_json(const RunResult& result, const Verdict& verdict) {
  const LoopReport& report = result.report;
  nlohmann::ordered_json json{{"device", result.device.uri}, {"device_model", as_json(result.device_model)},
                              {"ticks", report.ticks()},     {"executed", report.executed},
                              {"period_s", result.period_s}, {"missed", report.missed()}};
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
    json["missed_by"][stage_names[stage]] = report.missed_by[stage];
  }
  for (std::size_t cause = 0; cause < cause_names.size(); ++cause) {
    json["missed_because"][cause_names[cause]] = report.missed_because[cause];
  }
  json["late_ticks"] = nlohmann::ordered_json::array();
  for (const Miss& miss : report.first_misses()) json["late_ticks"].push_back(to_json(miss));
  json["stalls"] = nlohmann::ordered_json::array();
  for (const Stall& stall : result.stalls) json["stalls"].push_back(to_json(stall));
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
    json[std::string(stage_names[stage]) + "_us"] = to_json(report.stages[stage]);
  }
  json["cycle_us"] = to_json(report.cycle);
  json["compute_cpu_us"] = to_json(report.compute_cpu);
  json["energy_J"] = report.energy_j;
  json["passive"] = report.least_energy_j >= -passive_within_j;
  json["ticks_with"] = nlohmann::ordered_json::object();
  for (const schema::FlagInfo& flag : schema::flag_table) {
    json["ticks_with"][std::string(flag.name)] = report.ticks_with(flag.flag);
  }
  json["rows_lost"] = result.rows_lost;
  json["device_figures"] = figures_as_json(result.figures);
  json["page_faults"] = result.usage.page_faults + result.usage.major_page_faults;
  json["involuntary_switches"] = result.usage.involuntary_switches;
  json["spin_us"] = to_us(static_cast<double>(result.spin_ns));
  json["floor"] = result.floor ? to_json(*result.floor) : nlohmann::ordered_json(nullptr);
  json["realtime"] = nlohmann::ordered_json::array();
  for (const RealtimeMeasure& measure : result.realtime) {
    json["realtime"].push_back(
        {{"name", measure.name}, {"obtained", measure.obtained}, {"detail", measure.detail}});
  }
  json["histograms"] = {{"wake_us", buckets_of(report.stages[0])},
                        {"cycle_us", buckets_of(report.cycle)},
                        {"compute_cpu_us", buckets_of(report.compute_cpu)}};
  json["verdict"] = name_of(verdict);
  json["causes"] = nlohmann::ordered_json::array();
  for (const Cause cause : verdict.causes)
    json["causes"].push_back(cause_names[static_cast<std::size_t>(cause)]);
  json["reasons"] = verdict.reasons;
  return json;
}

}  // namespace kerf::bench
