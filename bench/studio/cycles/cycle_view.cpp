#include "cycles/cycle_view.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

#include <kerf/fitting/jnd.h>

#include "files/json_number.h"
#include "http/routes.h"
#include "inspect/flagged_cycles.h"
#include "recordings/axis_values.h"
#include "recordings/provenance.h"
#include "views/hysteresis_loops.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_phases = 40'000;
constexpr std::size_t most_said = 10'000;

SegmentOptions settings_in(const nlohmann::json& given, std::size_t axis) {
  SegmentOptions options{.axis = axis};
  options.prominence = number_or(given, "prominence", options.prominence, 0.01, 0.99);
  options.corner_hz = number_or(given, "corner_hz", options.corner_hz, 1e-3, 1e6);
  options.dwell = number_or(given, "dwell", options.dwell, 0.001, 0.49);
  const std::string closing = text_or(given, "closing", "");
  if (closing == "increasing" || closing == "decreasing") {
    options.closing_direction = closing == "increasing" ? 1.0 : -1.0;
  } else if (!closing.empty()) {
    throw RequestError(400, "'closing' is neither 'increasing' nor 'decreasing' nor empty");
  }
  return options;
}

Json as_json(const std::optional<SegmentOptions>& settings) {
  const SegmentOptions it = settings.value_or(SegmentOptions{});
  const double closing = it.closing_direction.value_or(0.0);
  return {{"prominence", it.prominence},
          {"corner_hz", it.corner_hz},
          {"dwell", it.dwell},
          {"closing", closing > 0.0   ? "increasing"
                      : closing < 0.0 ? "decreasing"
                                      : ""}};
}

std::vector<schema::PhaseSpan> phases_in(const nlohmann::json& given) {
  std::vector<schema::PhaseSpan> phases;
  const auto found = given.find("phases");
  if (found == given.end() || found->is_null()) return phases;
  if (!found->is_array() || found->size() > most_phases)
    throw RequestError(400, fmt::format("'phases' is not a list of at most {} phases", most_phases));
  for (const nlohmann::json& one : *found) {
    const bool is_phase =
        one.is_array() && one.size() >= 4 &&
        std::all_of(one.begin(), one.begin() + 4, [](const auto& n) { return n.is_number_unsigned(); });
    if (!is_phase) throw RequestError(400, "a phase is not [cycle, phase, begin, end] in whole numbers");
    const auto kind = one[1].get<std::uint64_t>();
    if (kind < 1 || kind > 4) throw RequestError(400, "a phase is a number from 1 to 4");
    phases.push_back({.cycle = one[0].get<std::uint32_t>(),
                      .phase = static_cast<schema::Phase>(kind),
                      .begin = one[2].get<std::uint64_t>(),
                      .end = one[3].get<std::uint64_t>()});
  }
  return phases;
}

std::vector<schema::CycleFlag> said_in_request(const nlohmann::json& given) {
  std::vector<schema::CycleFlag> said;
  const auto found = given.find("said");
  if (found == given.end() || found->is_null()) return said;
  if (!found->is_array() || found->size() > most_said)
    throw RequestError(400, fmt::format("'said' is not a list of at most {} remarks", most_said));
  for (const nlohmann::json& one : *found) {
    if (!one.is_object()) throw RequestError(400, "'said' is not a list of remarks");
    said.push_back({.cycle = static_cast<std::uint32_t>(number_in(one, "cycle", 1.0, 4e9)),
                    .fault = text_in(one, "kind"),
                    .reason = text_in(one, "reason")});
    std::ranges::replace(said.back().reason, '\n', ' ');
  }
  return said;
}

std::optional<CycleStep> step_in(const nlohmann::json& given) {
  const auto found = given.find("step");
  if (found == given.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw RequestError(400, "'step' is no step");
  CycleStep step{.kind = CycleStep::Kind::split,
                 .cycle = static_cast<std::uint32_t>(number_in(*found, "cycle", 1.0, 4e9)),
                 .row = 0};
  const std::string kind = text_in(*found, "kind");
  if (kind == "split") {
    step.row = static_cast<std::uint64_t>(number_in(*found, "row", 0.0, 1e15));
  } else if (kind == "merge") {
    step.kind = CycleStep::Kind::merge;
  } else {
    throw RequestError(400, "a step is neither 'split' nor 'merge'");
  }
  return step;
}

Json said_as_json(const std::vector<schema::CycleFlag>& said) {
  Json list = Json::array();
  for (const schema::CycleFlag& one : said)
    list.push_back({{"cycle", one.cycle}, {"kind", one.fault}, {"reason", one.reason}});
  return list;
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(json_number(value));
  return list;
}

Json phases_as_json(const schema::RecordingFile& file, const schema::Cycles& cycles) {
  const BlockedValues time_s = axis_values(file, schema::Column::time);
  const auto at = [&](std::uint64_t row) { return json_number(time_s[std::min(row, time_s.size() - 1)]); };
  Json list = Json::array();
  for (const schema::PhaseSpan& phase : cycles.phases) {
    if (phase.begin >= phase.end || phase.end > file.rows())
      continue;  // of a file that does not hold together
    Json begin_s = at(phase.begin);
    list.push_back({phase.cycle, static_cast<int>(phase.phase), phase.begin, phase.end, std::move(begin_s),
                    at(phase.end)});
  }
  return list;
}

Json cycles_as_json(const std::vector<FlaggedCycle>& flagged) {
  Json list = Json::array();
  for (const FlaggedCycle& cycle : flagged) {
    Json flags = Json::array();
    for (const CycleFlag& flag : cycle.flags)
      flags.push_back({{"kind", name_of(flag.fault)}, {"reason", flag.reason}});
    list.push_back({{"number", cycle.facts.number},
                    {"good", cycle.is_good()},
                    {"accepted", cycle.accepted ? Json(*cycle.accepted) : Json(nullptr)},
                    {"flags", std::move(flags)},
                    {"peak", json_number(cycle.facts.peak)},
                    {"work", json_number(cycle.facts.work)}});
  }
  return list;
}

/// One loop, of the rows that its phases have now.
Json loop_as_json(RecordingView& recording, const schema::Cycles& cycles, std::uint32_t wanted) {
  AxisCycles::Rows rows{.cycle = wanted, .begin = recording.file().rows(), .end = 0};
  for (const schema::PhaseSpan& phase : cycles.phases) {
    if (phase.cycle != wanted || phase.end > recording.file().rows()) continue;
    rows.begin = std::min(rows.begin, phase.begin);
    rows.end = std::max(rows.end, phase.end);
  }
  if (rows.begin >= rows.end) return nullptr;
  AxisCycles one;
  one.cycles.push_back(rows);
  one.contact = recording.cycles_along(cycles.axis).contact;
  const std::vector<ForceLoop> loops = force_loops(recording.file(), cycles.axis, one, 1, 1);
  if (loops.empty()) return nullptr;
  return {{"cycle", wanted}, {"position", numbers(loops[0].position)}, {"force", numbers(loops[0].force)}};
}

Json edits_as_json(const schema::Recording& about) {
  Json list = Json::array();
  for (const ToldEdit& edit : edits_of(about))
    list.push_back({{"time", edit.time}, {"author", edit.author}, {"what", edit.what}});
  return list;
}

}  // namespace

CycleQuestion cycle_question(const nlohmann::json& given, const schema::Recording& about) {
  CycleQuestion question;
  question.axis = static_cast<std::size_t>(
      number_or(given, "axis", about.cycles ? static_cast<double>(about.cycles->axis) : 0.0, 0.0,
                static_cast<double>(about.dimensions()) - 1.0));
  const auto settings = given.find("settings");
  if (settings != given.end() && settings->is_object()) {
    question.edit.found_by = settings_in(*settings, question.axis);
  } else if (!about.cycles || about.cycles->axis != question.axis) {
    question.edit.found_by = SegmentOptions{.axis = question.axis};
  }
  question.edit.phases = phases_in(given);
  question.edit.said =
      given.contains("said") || question.edit.found_by ? said_in_request(given) : said_by_hand(about);
  question.step = step_in(given);
  question.loop = static_cast<std::uint32_t>(number_or(given, "loop", 0.0, 0.0, 4e9));
  return question;
}

std::string cycles_version(const schema::RecordingFile& file) {
  const schema::Recording& about = file.about();
  return sha256_of(std::string_view(fmt::format("{}\n{}\n{}\n{}", about.header.uuid, file.rows(),
                                                about.header.history, cycles_sha256_of(about))))
      .substr(0, 16);
}

std::string why_not_mended(const schema::RecordingFile& file, const std::filesystem::path& path) {
  if (file.is_live())
    return "It is still written, or was left by a crash: its cycles are kept once it is closed.";
  if (file.rows() > max_rows_mended)
    return fmt::format("It has {} rows; cycles of more than {} are found by 'kerf segment'.", file.rows(),
                       max_rows_mended);
  if (::access(path.c_str(), W_OK) != 0)
    return fmt::format("{} may not be written: give yourself the right to write it.",
                       path.filename().string());
  if (::access(path.parent_path().c_str(), W_OK) != 0)
    return fmt::format("The folder of {} may not be written: give yourself the right to write in it.",
                       path.filename().string());
  return "";
}

double felt_along(const schema::Recording& about, std::size_t axis) {
  const schema::Axis& along = about.axes.at(axis);
  return fitting::jnd_of(along.force_unit, along.lever).threshold;
}

Json cycle_view(RecordingView& recording, const std::filesystem::path& path, const CycleQuestion& question) {
  const schema::RecordingFile& file = recording.file();
  Json json{{"version", cycles_version(file)},
            {"stored", !question.edit.found_by.has_value()},
            {"locked", why_not_mended(file, path)},
            {"axis", question.axis},
            {"rows", file.rows()},
            {"settings", as_json(question.edit.found_by)},
            {"closing_direction", 1.0},
            {"contact_position", nullptr},
            {"why_none", ""},
            {"phases", Json::array()},
            {"cycles", Json::array()},
            {"said", said_as_json(question.edit.said)},
            {"average", nullptr},
            {"loop", nullptr},
            {"edits", edits_as_json(file.about())}};
  if (file.rows() > max_rows_mended) {
    json["why_none"] = json["locked"];
    return json;
  }
  EditedCycles edited;
  try {
    edited = edited_cycles(file, question.edit, felt_along(file.about(), question.axis));
  } catch (const std::invalid_argument& error) {
    // What was asked for as it stands is refused; that nothing is found is an answer.
    if (!question.edit.phases.empty() || !question.edit.said.empty()) throw;
    json["why_none"] = error.what();
    return json;
  }
  const schema::Cycles& cycles = edited.cycles;
  json["closing_direction"] = cycles.closing_direction;
  json["contact_position"] = json_number(cycles.contact_position);
  json["phases"] = phases_as_json(file, cycles);
  json["cycles"] = cycles_as_json(edited.flagged);
  std::vector<bool> is_good;
  for (const FlaggedCycle& cycle : edited.flagged) is_good.push_back(cycle.is_good());
  const CycleMeans means = means_of_good_cycles(cycles, is_good);
  json["average"] = {{"position", numbers(cycles.grid)},
                     {"closing", numbers(means.closing)},
                     {"opening", numbers(means.opening)}};
  if (question.loop > 0) json["loop"] = loop_as_json(recording, cycles, question.loop);
  return json;
}

}  // namespace kerf::bench
