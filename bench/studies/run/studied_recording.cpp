#include "run/studied_recording.h"

#include <cmath>
#include <limits>

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// JSON has no infinity and no NaN: what there is no number for is null.
json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }
double number_or(const json& value, double none) { return value.is_null() ? none : value.get<double>(); }

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double no_limit = std::numeric_limits<double>::infinity();

json parameter_as_json(const StudiedParameter& parameter) {
  return {{"name", parameter.name},
          {"unit", parameter.unit},
          {"value", parameter.value},
          {"std_error", number_or_null(parameter.std_error)},
          {"is_positive", parameter.is_positive}};
}

json parameters_as_json(const std::vector<StudiedParameter>& all) {
  json parameters = json::array();
  for (const StudiedParameter& parameter : all) parameters.push_back(parameter_as_json(parameter));
  return parameters;
}

json law_as_json(const StudiedLaw& law) {
  return {{"model", law.model},
          {"free_parameters", law.free_parameters},
          {"rmse", law.rmse},
          {"held_out", number_or_null(law.held_out)},
          {"can_be_chosen", law.can_be_chosen},
          {"within_jnd", law.within_jnd},
          {"blame", law.blame},
          {"parameters", parameters_as_json(law.parameters)},
          {"taken_from_it", law.taken_from_it}};
}

json cycle_as_json(const StudiedCycle& cycle) {
  return {{"cycle", cycle.number}, {"begin_s", cycle.begin_s},           {"closing_s", cycle.closing_s},
          {"peak", cycle.peak},    {"closing_work", cycle.closing_work}, {"good", cycle.is_good},
          {"reason", cycle.reason}};
}

std::vector<StudiedParameter> studied_parameters(const json& from) {
  std::vector<StudiedParameter> parameters;
  for (const json& one : from)
    parameters.push_back({.name = one.at("name"),
                          .unit = one.at("unit"),
                          .value = one.at("value"),
                          .std_error = number_or(one.at("std_error"), no_limit),
                          .is_positive = one.at("is_positive")});
  return parameters;
}

StudiedLaw studied_law(const json& from) {
  StudiedLaw law{.model = from.at("model"),
                 .free_parameters = from.at("free_parameters"),
                 .rmse = from.at("rmse"),
                 .held_out = number_or(from.at("held_out"), no_number),
                 .can_be_chosen = from.at("can_be_chosen"),
                 .within_jnd = from.at("within_jnd"),
                 .blame = from.at("blame"),
                 .parameters = {}};
  law.parameters = studied_parameters(from.at("parameters"));
  if (from.contains("taken_from_it")) law.taken_from_it = from.at("taken_from_it");
  return law;
}

StudiedCycle studied_cycle(const json& from) {
  return {.number = from.at("cycle"),
          .begin_s = from.at("begin_s"),
          .closing_s = from.at("closing_s"),
          .peak = from.at("peak"),
          // Earlier versions called it an energy, whatever the axis.
          .closing_work = from.at(from.contains("closing_work") ? "closing_work" : "closing_work_J"),
          .is_good = from.at("good"),
          .reason = from.at("reason")};
}

StudiedBlank studied_blank(const json& from) {
  StudiedBlank blank;
  if (from.at("blank").is_null()) {
    blank.why_none = from.at("why_none");
    return blank;
  }
  blank.name = from.at("blank");
  blank.rows = from.at("rows");
  blank.covered = from.at("rows_covered");
  blank.cycles = from.at("cycles");
  blank.force_rms = from.at("force_rms");
  blank.taken_rms = from.at("taken_rms");
  blank.spread_rms = from.at("spread_rms");
  blank.negative_before = from.at("negative_before");
  blank.negative_after = from.at("negative_after");
  blank.pulling_share = from.at("pulling_share");
  for (const json& span : from.value("rows_not_covered", json::array()))
    blank.uncovered.push_back({.begin = span.at(0), .end = span.at(1)});
  for (const json& part : from.value("without_parts", json::array())) {
    auto& values = blank.without.emplace_back();
    for (const auto& [name, value] : part.items()) values[name] = number_or(value, no_number);
  }
  return blank;
}

StudiedBlade studied_blade(const json& from) {
  StudiedBlade blade;
  if (from.contains("why_none")) {
    blade.why_none = from.at("why_none");
    return blade;
  }
  blade.rows_in_tissue = from.at("rows_in_tissue");
  blade.rmse = from.at("rmse_N");
  blade.rms = from.at("rms_N");
  blade.parameters = studied_parameters(from.at("parameters"));
  return blade;
}

StudiedJoin studied_join(const json& from) {
  return {.file = from.at("file"),
          .on = from.at("on"),
          .shift_s = from.at("shift_s"),
          .shift_error_s = number_or(from.at("shift_std_error_s"), no_number),
          .skew = from.at("skew"),
          .skew_error = number_or(from.at("skew_std_error"), no_number),
          .correlation = number_or(from.at("correlation"), no_number),
          .markers = from.value("markers", std::uint64_t{0}),
          .rows_left_out = from.at("rows_left_out")};
}

}  // namespace

json as_json(const StudiedJoin& join) {
  json all{{"file", join.file},
           {"on", join.on},
           {"shift_s", join.shift_s},
           {"shift_std_error_s", number_or_null(join.shift_error_s)},
           {"skew", join.skew},
           {"skew_std_error", number_or_null(join.skew_error)},
           {"correlation", number_or_null(join.correlation)},
           {"rows_left_out", join.rows_left_out}};
  if (join.markers > 0) all["markers"] = join.markers;
  return all;
}

json as_json(const StudiedBlade& blade) {
  if (!blade.why_none.empty()) return {{"why_none", blade.why_none}};
  return {{"rows_in_tissue", blade.rows_in_tissue},
          {"rmse_N", blade.rmse},
          {"rms_N", blade.rms},
          {"parameters", parameters_as_json(blade.parameters)}};
}

json as_json(const StudiedBlank& blank) {
  if (!blank.is_taken()) return {{"blank", nullptr}, {"why_none", blank.why_none}};
  json uncovered = json::array();
  for (const RowSpan& span : blank.uncovered) uncovered.push_back({span.begin, span.end});
  json without = json::array();
  for (const auto& values : blank.without) {
    json& part = without.emplace_back(json::object());
    for (const auto& [name, value] : values) part[name] = number_or_null(value);
  }
  return {{"blank", blank.name},
          {"rows", blank.rows},
          {"rows_covered", blank.covered},
          {"cycles", blank.cycles},
          {"force_rms", blank.force_rms},
          {"taken_rms", blank.taken_rms},
          {"spread_rms", blank.spread_rms},
          {"negative_before", blank.negative_before},
          {"negative_after", blank.negative_after},
          {"pulling_share", blank.pulling_share},
          {"rows_not_covered", std::move(uncovered)},
          {"without_parts", std::move(without)}};
}

std::vector<double> of_cycles(const StudiedRecording& recording, double StudiedCycle::*quantity,
                              bool all_cycles) {
  std::vector<double> values;
  for (const StudiedCycle& cycle : recording.cycles)
    if (cycle.is_good || all_cycles) values.push_back(cycle.*quantity);
  return values;
}

json as_json(const StudiedRecording& recording) {
  json all{{"key", recording.key}, {"failure", recording.failure}};
  if (!recording.failure.empty()) return all;
  json cycles = json::array();
  for (const StudiedCycle& cycle : recording.cycles) cycles.push_back(cycle_as_json(cycle));
  json laws = json::array();
  for (const StudiedLaw& law : recording.laws) laws.push_back(law_as_json(law));
  all.update({{"content_sha256", recording.content},
              {"rows", recording.rows},
              {"duration_s", recording.duration_s},
              {"period_s", recording.period_s},
              {"axis", recording.axis},
              {"position_unit", recording.position_unit},
              {"force_unit", recording.force_unit},
              {"travel", recording.travel},
              {"peak", recording.peak},
              {"rms", recording.rms},
              {"jnd", recording.jnd},
              {"floor", number_or_null(recording.floor)},
              {"closing_direction", recording.closing_direction},
              {"clipped_at", number_or_null(recording.clipped_at)},
              {"clipped_rows", recording.clipped_rows},
              {"least_shown", number_or_null(recording.least_shown)},
              {"warnings", recording.warnings},
              {"cycles", cycles},
              {"laws", laws},
              {"chosen", recording.chosen},
              {"why_chosen", recording.why_chosen},
              {"not_fitted", recording.not_fitted}});
  if (recording.join) all["joined"] = as_json(*recording.join);
  if (recording.blade) all["blade"] = as_json(*recording.blade);
  if (recording.blank) all["blank_taken_off"] = as_json(*recording.blank);
  return all;
}

StudiedRecording studied_recording(const json& from) {
  StudiedRecording recording;
  recording.key = from.at("key");
  recording.failure = from.at("failure");
  if (!recording.failure.empty()) return recording;
  recording.content = from.at("content_sha256");
  recording.rows = from.at("rows");
  recording.duration_s = from.at("duration_s");
  recording.period_s = from.at("period_s");
  recording.axis = from.at("axis");
  recording.position_unit = from.at("position_unit");
  recording.force_unit = from.at("force_unit");
  recording.travel = from.at("travel");
  recording.peak = from.at("peak");
  recording.rms = from.at("rms");
  recording.jnd = from.at("jnd");
  recording.floor = number_or(from.at("floor"), no_number);
  recording.closing_direction = from.at("closing_direction");
  recording.clipped_at = number_or(from.at("clipped_at"), no_number);
  recording.clipped_rows = from.at("clipped_rows");
  recording.least_shown = number_or(from.at("least_shown"), no_number);
  if (from.contains("joined")) recording.join = studied_join(from.at("joined"));
  if (from.contains("blade")) recording.blade = studied_blade(from.at("blade"));
  if (from.contains("blank_taken_off")) recording.blank = studied_blank(from.at("blank_taken_off"));
  recording.warnings = from.at("warnings");
  for (const json& cycle : from.at("cycles")) recording.cycles.push_back(studied_cycle(cycle));
  for (const json& law : from.at("laws")) recording.laws.push_back(studied_law(law));
  recording.chosen = from.at("chosen");
  recording.why_chosen = from.at("why_chosen");
  recording.not_fitted = from.at("not_fitted");
  return recording;
}

}  // namespace kerf::bench
