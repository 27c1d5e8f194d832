#include "loop/check.h"

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double compute_share = 0.5;      ///< of the period that the computation may take
constexpr double missed_share = 0.01;      ///< of the deadlines that may be missed
constexpr double passive_within_j = 1e-3;  ///< energy that quantised positions may feign

double to_us(double nanoseconds) { return 1e-3 * nanoseconds; }

nlohmann::ordered_json to_json(const Histogram& histogram) {
  return {{"mean", to_us(histogram.mean_ns())},
          {"p50", to_us(histogram.percentile_ns(0.5))},
          {"p99", to_us(histogram.percentile_ns(0.99))},
          {"p999", to_us(histogram.percentile_ns(0.999))},
          {"max", to_us(histogram.max_ns())}};
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

}  // namespace

Verdict judge(const RunResult& result) {
  const LoopReport& report = result.report;
  Verdict verdict;
  const auto fail = [&](std::string reason) {
    verdict.passed = false;
    verdict.reasons.push_back(std::move(reason));
  };
  const double period_ns = 1e9 * result.period_s;
  const double compute_ns = report.stages[static_cast<std::size_t>(Stage::compute)].percentile_ns(0.999);
  if (compute_ns > compute_share * period_ns) {
    fail(fmt::format("the law is too slow: 99.9 % of its ticks take up to {:.1f} us of a period of {:.0f} us",
                     to_us(compute_ns), to_us(period_ns)));
  }
  const double ticks = static_cast<double>(report.ticks());
  const auto by_wake = report.missed_by[static_cast<std::size_t>(Stage::wake)];
  const double missed = static_cast<double>(report.missed());
  const std::string lateness =
      fmt::format("{} of {:.0f} deadlines missed, {} of them because the machine woke the loop late",
                  report.missed(), ticks, by_wake);
  if (missed > missed_share * ticks) {
    fail(lateness);
  } else if (report.missed() > 0) {
    verdict.reasons.push_back(lateness);
  }
  if (report.law_faults > 0) fail(fmt::format("the law gave no finite force in {} ticks", report.law_faults));
  if (report.device_faults > 0)
    fail(fmt::format("the device did not answer in {} ticks", report.device_faults));
  if (report.limited > 0)
    verdict.reasons.push_back(fmt::format("the force was limited in {} ticks", report.limited));
  if (report.least_energy_j < -passive_within_j) {
    verdict.reasons.push_back(fmt::format("the rendering gave up to {:.3g} J more than it took: not passive",
                                          -report.least_energy_j));
  }
  if (report.end == LoopEnd::stopped) verdict.reasons.emplace_back("ended early by a signal");
  return verdict;
}

nlohmann::ordered_json check_as_json(const RunResult& result, const Verdict& verdict) {
  const LoopReport& report = result.report;
  nlohmann::ordered_json json{{"device", result.device.uri},
                              {"ticks", report.ticks()},
                              {"executed", report.executed},
                              {"period_s", result.period_s},
                              {"missed", report.missed()}};
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
    json["missed_by"][stage_names[stage]] = report.missed_by[stage];
  }
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
    json[std::string(stage_names[stage]) + "_us"] = to_json(report.stages[stage]);
  }
  json["cycle_us"] = to_json(report.cycle);
  json["energy_J"] = report.energy_j;
  json["passive"] = report.least_energy_j >= -passive_within_j;
  json["law_faults"] = report.law_faults;
  json["device_faults"] = report.device_faults;
  json["limited"] = report.limited;
  json["rows_lost"] = result.rows_lost;
  json["realtime"] = nlohmann::ordered_json::array();
  for (const RealtimeMeasure& measure : result.realtime) {
    json["realtime"].push_back(
        {{"name", measure.name}, {"obtained", measure.obtained}, {"detail", measure.detail}});
  }
  json["histograms"] = {{"wake_us", buckets_of(report.stages[0])}, {"cycle_us", buckets_of(report.cycle)}};
  json["verdict"] = verdict.passed ? "pass" : "fail";
  json["reasons"] = verdict.reasons;
  return json;
}

}  // namespace kerf::bench
