#include "prepare/prepared_text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include "files/json_number.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const Weight& weight) {
  return {{"mass_kg", weight.mass_kg},
          {"mass_error_kg", weight.mass_error_kg},
          {"centre_m", weight.centre_m},
          {"centre_error_m", weight.centre_error_m},
          {"force_bias_n", weight.force_bias_n},
          {"torque_bias_nm", weight.torque_bias_nm},
          {"estimated", weight.estimated},
          {"rows", weight.rows},
          {"condition", weight.condition},
          {"tilt_deg", weight.tilt_deg},
          {"force_noise_n", weight.force_noise_n}};
}

ordered_json to_json(const Bias& bias) {
  ordered_json axes = ordered_json::array();
  for (const AxisBias& axis : bias.axes) {
    axes.push_back({{"axis", axis.axis},
                    {"unit", axis.unit},
                    {"offset", axis.offset},
                    {"offset_error", axis.offset_error},
                    {"drift_per_minute", axis.drift_per_minute},
                    {"drift_per_minute_error", axis.drift_per_minute_error},
                    {"noise", axis.noise},
                    {"correlation_rows", axis.correlation_rows}});
  }
  return {{"rows", bias.rows}, {"axes", axes}};
}

ordered_json to_json(const BlankBranch& branch) {
  ordered_json mean = ordered_json::array();
  ordered_json spread = ordered_json::array();
  for (std::size_t i = 0; i < branch.mean.size(); ++i) {
    mean.push_back(json_number(branch.mean[i]));
    spread.push_back(json_number(branch.spread[i]));
  }
  return {{"mean", mean},
          {"spread", spread},
          {"cycles", branch.cycles},
          {"slowest", branch.slowest},
          {"median_speed", branch.median_speed},
          {"fastest", branch.fastest}};
}

ordered_json to_json(const UncoveredRows& uncovered) {
  ordered_json json{{"rows", uncovered.rows}, {"least", nullptr}, {"most", nullptr}};
  if (uncovered.rows > 0) {
    json["least"] = json_number(uncovered.least);
    json["most"] = json_number(uncovered.most);
  }
  return json;
}

ordered_json to_json(const BlankTaken& taken) {
  const ToolForce& tool = taken.tool;
  const auto known = [](const std::optional<double>& value) {
    return value ? json_number(*value) : ordered_json(nullptr);
  };
  return {
      {"file", taken.file},
      {"uuid", taken.uuid},
      {"sha256", taken.sha256},
      {"axis", taken.axis},
      {"force_unit", taken.force_unit},
      {"position_unit", taken.position_unit},
      {"rows", taken.rows},
      {"rows_covered", taken.covered},
      {"of_no_cycle", to_json(taken.of_no_cycle)},
      {"out_of_range", to_json(taken.out_of_range)},
      {"too_fast", to_json(taken.too_fast)},
      {"too_slow", to_json(taken.too_slow)},
      {"uncovered", taken.are_dropped ? "drop" : "keep"},
      {"force_rms", taken.force_rms},
      {"taken_rms", taken.taken_rms},
      {"spread_rms", taken.spread_rms},
      {"error_rms", taken.error_rms},
      {"told_share", taken.told_share},
      {"negative_before", taken.negative_before},
      {"negative_after", taken.negative_after},
      {"pulling_share", taken.pulling_share},
      {"pulling_least", taken.pulling_share > 0.0 ? json_number(taken.pulling_least) : ordered_json(nullptr)},
      {"pulling_most", taken.pulling_share > 0.0 ? json_number(taken.pulling_most) : ordered_json(nullptr)},
      {"closing_speed", taken.closing_speed},
      {"opening_speed", taken.opening_speed},
      {"inertia",
       {{"value", known(tool.inertia.value)},
        {"error", known(tool.inertia.error)},
        {"noise_share", tool.inertia.noise_share},
        {"determined", tool.inertia.is_determined}}},
      {"cycles", tool.used},
      {"cycles_left_out", as_json(tool.left_out)},
      {"grid", tool.grid},
      {"closing", to_json(tool.closing)},
      {"opening", to_json(tool.opening)}};
}

ordered_json to_json(const ContactsFound& found, const std::string& signal) {
  ordered_json contacts = ordered_json::array();
  for (const ContactFound& contact : found.contacts) {
    contacts.push_back({{"onset_s", contact.onset_s},
                        {"onset_error_s", json_number(contact.onset_error_s)},
                        {"onset_position", json_number(contact.onset_position)},
                        {"onset_position_error", json_number(contact.onset_position_error)},
                        {"bend", json_number(contact.bend)},
                        {"bend_error", json_number(contact.bend_error)},
                        {"travel", contact.travel},
                        {"first_row", contact.rows.begin},
                        {"rows", contact.rows.end - contact.rows.begin},
                        {"peak", contact.peak},
                        {"refined", contact.refined}});
  }
  return {{"signal", signal},
          {"noise", found.noise},
          {"threshold", found.threshold},
          {"count", found.contacts.size()},
          {"found", contacts}};
}

ordered_json to_json(const FilterReport& report) {
  ordered_json responses = ordered_json::array();
  for (const Response& response : report.responses) {
    responses.push_back({{"frequency_hz", response.frequency_hz},
                         {"gain", response.gain},
                         {"phase_deg", response.phase_deg},
                         {"delay_ms", response.delay_ms}});
  }
  return {{"filter", to_text(report.filter)},
          {"rate_hz", report.rate_hz},
          {"stretches", report.stretches},
          {"response", responses}};
}

ordered_json to_json(const ErrorOf& error) {
  return {{"bias_s", error.bias_s}, {"median_s", error.median_s}, {"percentile_90_s", error.percentile_90_s}};
}

ordered_json to_json(const ContactScore& score) {
  return {{"labelled", score.labelled},
          {"detected", score.detected},
          {"found", score.found},
          {"missed", score.missed},
          {"false", score.false_ones},
          {"split_up", score.split_up},
          {"begin", to_json(score.begin)},
          {"end", to_json(score.end)},
          {"precision", score.precision},
          {"recall", score.recall},
          {"f1", score.f1}};
}

using Lines = std::vector<std::string>;

void add_filter(const FilterReport& report, Lines& lines) {
  lines.push_back(fmt::format("filter {} at {:.6g} Hz", to_text(report.filter), report.rate_hz));
  lines.push_back(fmt::format("  {:>9} {:>9} {:>10} {:>9}", "Hz", "gain dB", "phase deg", "delay ms"));
  for (const Response& response : report.responses) {
    lines.push_back(fmt::format("  {:9g} {:9.2f} {:10.2f} {:9.3f}", response.frequency_hz,
                                20.0 * std::log10(std::max(response.gain, 1e-15)), response.phase_deg + 0.0,
                                response.delay_ms + 0.0));
  }
}

void add_blank(const BlankTaken& taken, Lines& lines) {
  const std::string& unit = taken.force_unit;
  const auto share = [&](std::size_t rows) {
    return 100.0 * static_cast<double>(rows) / static_cast<double>(taken.rows);
  };
  lines.push_back(fmt::format("  taken off {:.4g} {} of {:.4g} {} (rms), in {:.0f} % of the rows",
                              taken.taken_rms, unit, taken.force_rms, unit, share(taken.covered)));
  lines.push_back(fmt::format(
      "  it differs by {:.3g} {} (rms) from one cycle of the blank to the next; the mean of its {} cycles is "
      "known "
      "to {:.3g} {}, and more than two such errors from zero in {:.0f} % of these rows",
      taken.spread_rms, unit, taken.tool.used.size(), taken.error_rms, unit, 100.0 * taken.told_share));
  for (const LeftOutCycle& cycle : taken.tool.left_out)
    lines.push_back(fmt::format("  cycle {} of the blank not used: {}", cycle.number, cycle.reason));
  const auto uncovered = [&](std::string_view what, const UncoveredRows& rows) {
    if (rows.rows == 0) return;
    lines.push_back(fmt::format("  {} rows ({:.0f} %) {}, at {:.4g} to {:.4g} {}: {}", rows.rows,
                                share(rows.rows), what, rows.least, rows.most, taken.position_unit,
                                taken.are_dropped ? "left out" : "left as they were"));
  };
  uncovered("where the blank has not been", taken.out_of_range);
  uncovered("of strokes faster than the blank's", taken.too_fast);
  uncovered("of strokes slower than the blank's", taken.too_slow);
  uncovered("of no cycle", taken.of_no_cycle);
  lines.push_back(
      fmt::format("  of the covered rows the force is below zero in {:.1f} % before and {:.1f} % after, in "
                  "{:.1f} % by more than two "
                  "spreads and 0.05 N, which the blank does not explain",
                  100.0 * taken.negative_before, 100.0 * taken.negative_after, 100.0 * taken.pulling_share));
}

void add_score(const ContactScore& score, Lines& lines) {
  lines.push_back(fmt::format(
      "  of {} labelled {} found, {} missed; of {} detected {} false, {} more on one label", score.labelled,
      score.found, score.missed, score.detected, score.false_ones, score.split_up));
  const auto add_error = [&](const char* what, const ErrorOf& error) {
    lines.push_back(fmt::format("  {} off by {:.3f} s (median), {:.3f} s (90th percentile), bias {:+.3f} s",
                                what, error.median_s, error.percentile_90_s, error.bias_s));
  };
  add_error("begin", score.begin);
  add_error("end  ", score.end);
  lines.push_back(fmt::format("  rows: precision {:.3f}, recall {:.3f}, F1 {:.3f}", score.precision,
                              score.recall, score.f1));
}

}  // namespace

ordered_json prepared_as_json(const Prepared& prepared) {
  ordered_json result{{"recording", prepared.recording.header.uuid},
                      {"source", prepared.recording.header.source},
                      {"rows_before", prepared.rows_before},
                      {"rows", prepared.recording.rows()},
                      {"gap_rows", prepared.gap_rows}};
  if (prepared.weight) result["weight"] = to_json(*prepared.weight);
  if (prepared.blank) result["blank"] = to_json(*prepared.blank);
  if (prepared.bias) result["bias"] = to_json(*prepared.bias);
  if (prepared.contacts) result["contacts"] = to_json(*prepared.contacts, prepared.contact_signal);
  if (prepared.filter) result["filter"] = to_json(*prepared.filter);
  if (prepared.score) result["score"] = to_json(*prepared.score);
  result["steps"] = prepared.steps;
  result["warnings"] = prepared.warnings;
  return result;
}

std::vector<std::string> prepared_lines(const Prepared& prepared) {
  Lines lines;
  for (const std::string& step : prepared.steps) {
    if (!step.starts_with("filter ")) lines.push_back(step);
  }
  if (prepared.blank) add_blank(*prepared.blank, lines);
  if (prepared.filter) add_filter(*prepared.filter, lines);
  if (prepared.score) add_score(*prepared.score, lines);
  return lines;
}

}  // namespace kerf::bench
