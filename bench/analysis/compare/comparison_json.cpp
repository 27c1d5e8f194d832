#include <algorithm>

#include "compare/finding_json.h"
#include "compare/run_comparison.h"
#include "files/json_number.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json worst_as_json(const compare::ForceDifference& one, const compare::Series& series) {
  return {{"tick", one.tick},
          {"got_tick", one.got_tick},
          {"channel", series.channels[one.channel].name},
          {"expected", json_number(one.expected)},
          {"got", json_number(one.got)},
          {"allowed", json_number(one.allowed)},
          {"jnds", json_number(one.jnds)}};
}

json bands_as_json(const std::vector<compare::BandLevel>& bands) {
  json list = json::array();
  for (const compare::BandLevel& one : bands)
    list.push_back({{"from_hz", one.from_hz},
                    {"to_hz", one.to_hz},
                    {"rms", json_number(one.rms)},
                    {"worst_rms", json_number(one.worst_rms)},
                    {"worst_time_s", json_number(one.worst_time_s)},
                    {"thresholds", json_number(one.thresholds())}});
  return list;
}

json events_as_json(const std::array<EventMatch, 3>& events) {
  json all;
  for (std::size_t kind = 0; kind < events.size(); ++kind) {
    const EventMatch& one = events[kind];
    all[std::string(force_event_names[kind])] = {
        {"expected", one.recorded},
        {"got", one.rendered},
        {"matched", one.late_s.size()},
        {"mean_late_ms", one.late_s.empty() ? json(nullptr) : json(1e3 * one.mean_s())},
        {"worst_late_ms", one.late_s.empty() ? json(nullptr) : json(1e3 * one.worst_s())}};
  }
  return all;
}

json channel_as_json(const RunComparison& result, std::size_t i) {
  const compare::ChannelComparison& about = result.comparison.channels[i];
  const compare::ChannelAgreement& one = result.agreement[i];
  json intervals = json::array();
  for (const compare::Interval& interval : about.intervals)
    intervals.push_back({interval.begin, interval.end});
  json coherence = json::array();
  for (const compare::BandCoherence& band : one.coherence)
    coherence.push_back(
        {{"from_hz", band.from_hz}, {"to_hz", band.to_hz}, {"coherence", json_number(band.coherence)}});
  return {
      {"name", one.channel.name},
      {"unit", one.channel.unit},
      {"outside", about.outside},
      {"first_outside", about.first_outside ? json(*about.first_outside) : json(nullptr)},
      {"not_finite", about.not_finite},
      {"intervals", intervals},
      {"largest_difference", json_number(about.largest_difference)},
      {"largest_tick", about.largest_at},
      {"largest_jnds", json_number(about.largest_jnds)},
      {"largest_expected", json_number(about.largest_expected)},
      {"largest_got", json_number(about.largest_got)},
      {"rms_difference", json_number(one.rms_difference)},
      {"gain", json_number(one.gain)},
      {"offset", json_number(one.offset)},
      {"drift", json_number(one.drift)},
      {"correlation", json_number(one.correlation)},
      {"latency_ms", one.latency_s ? json_number(1e3 * *one.latency_s) : json(nullptr)},
      {"latency_std_error_ms", one.latency_s ? json_number(1e3 * one.latency_std_error_s) : json(nullptr)},
      {"bands", bands_as_json(about.bands)},
      {"coherence", coherence},
      {"events", events_as_json(result.events[i])}};
}

json gaps_as_json(const std::vector<compare::TimeGap>& gaps) {
  json list = json::array();
  for (const compare::TimeGap& one : gaps)
    list.push_back({{"run", one.of_got ? "got" : "expected"},
                    {"from_s", one.begin_s},
                    {"to_s", one.end_s},
                    {"rows_not_compared", one.rows}});
  return list;
}

}  // namespace

json comparison_as_json(const RunComparison& result, const RunComparisonOptions& options) {
  const compare::Comparison& comparison = result.comparison;
  const compare::Series& series = result.runs.expected;
  const auto& lag = result.runs.lag;
  json all{
      {"expected", result.expected},
      {"got", result.got},
      {"passed", comparison.passed},
      {"align", compare::name_of(options.align.by)},
      {"lag",
       lag ? json{{"ms", 1e3 * lag->seconds}, {"std_error_ms", 1e3 * lag->std_error_s}, {"ticks", lag->ticks}}
           : json(nullptr)},
      {"expected_rows", comparison.expected_rows},
      {"got_rows", comparison.got_rows},
      {"compared_rows", series.rows()},
      {"differing", comparison.differing},
      {"outside", comparison.outside},
      {"messages", comparison.messages},
      {"explained", result.diagnosis.explained},
      {"names", findings_as_json(result.diagnosis.names, series.channels)},
      {"guesses", findings_as_json(result.diagnosis.guesses, series.channels)},
      {"sentences", result.names},
      {"notes", result.notes},
      {"worst", comparison.worst ? worst_as_json(*comparison.worst, series) : json(nullptr)},
      {"channels", json::array()}};
  if (!result.runs.gaps.empty()) all["gaps"] = gaps_as_json(result.runs.gaps);
  if (const auto& most = result.runs.no_lag_within_s) all["no_lag_within_ms"] = 1e3 * *most;
  for (std::size_t i = 0; i < comparison.channels.size(); ++i)
    all["channels"].push_back(channel_as_json(result, i));
  return all;
}

}  // namespace kerf::bench
