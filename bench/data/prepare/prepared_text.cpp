#include "prepare/prepared_text.h"

#include <algorithm>
#include <cmath>

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

ordered_json to_json(const ContactsFound& found, const std::string& signal) {
  ordered_json contacts = ordered_json::array();
  for (const ContactFound& contact : found.contacts) {
    contacts.push_back({{"onset_s", contact.onset_s},
                        {"onset_error_s", json_number(contact.onset_error_s)},
                        {"onset_position", json_number(contact.onset_position)},
                        {"onset_position_error", json_number(contact.onset_position_error)},
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
  if (prepared.filter) add_filter(*prepared.filter, lines);
  if (prepared.score) add_score(*prepared.score, lines);
  return lines;
}

}  // namespace kerf::bench
