#include "run/recording_step.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recorded_rows.h>

#include "files/json_file.h"
#include "files/whole_file.h"
#include "fits/fit_files.h"
#include "fits/fit_recording.h"
#include "fits/fit_series.h"
#include "fits/law_options.h"
#include "fits/row_doubts.h"
#include "import/import.h"
#include "inputs/study_imports.h"
#include "inspect/flagged_cycles.h"
#include "inspect/inspection.h"
#include "recordings/axes.h"
#include "recordings/provenance.h"
#include "recordings/row_figures.h"
#include "recordings/whole_recording.h"
#include "run/blank_parts.h"
#include "run/kept_recording.h"
#include "run/study_blade.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* first_result = "3";  // of what result.json holds: a number more makes all anew

void refuse_what_waits_for_a_word(const DrawerFile& file) {
  if (file.join_suggested.empty() || !file.join.empty()) return;
  throw std::invalid_argument(
      fmt::format("by its name {} is of the same recording: if so, make join_suggested join, with join_map "
                  "and join_on, or join_marker; if not, take it away",
                  file.join_suggested));
}

schema::Recording imported_or_read(const RecordingStep& step, StudiedRecording& result) {
  refuse_what_waits_for_a_word(*step.file);
  if (step.join && step.source.extension() == ".h5")
    throw std::invalid_argument(
        "'join' takes a file to a text, a workbook or a MAT-file, not to a recording");
  if (step.source.extension() == ".h5") return read_whole_recording(step.source);
  if (step.import.map.empty())
    throw std::invalid_argument("its columns are unknown: give it, or the study, a map");
  Imported imported = import_text(step.source, step.import.options);
  if (step.join) join_other(*step.join, imported, result);
  result.warnings = std::move(imported.warnings);
  return std::move(imported.recording);
}

double felt_along(const schema::Axis& axis) { return fitting::jnd_of(axis.force_unit, axis.lever).threshold; }

SegmentOptions segment_options(const StudyPlan& plan) {
  SegmentOptions options;
  if (!plan.closing.empty()) options.closing_direction = plan.closing == "increasing" ? 1.0 : -1.0;
  return options;
}

/// Cycles that the recording has stay, unless they are along another axis than the one that is named. Of
/// several axes none is taken for the tool's way unless a person names it.
void find_cycles_of(const RecordingStep& step, schema::Recording& recording, StudiedRecording& result) {
  const std::string& named = step.file->axis;
  SegmentOptions options = segment_options(*step.plan);
  options.axis = find_axis(recording, named);
  if (recording.cycles && (named.empty() || recording.cycles->axis == options.axis)) return;
  if (recording.dimensions() > 1 && named.empty()) return;
  recording.cycles.reset();
  try {
    segment_recording(recording, schema::RowsInMemory(recording), options, step.file->path);
  } catch (const std::invalid_argument& error) {
    result.warnings.push_back(fmt::format("it has no cycles: {}", error.what()));
  }
}

std::vector<FlaggedCycle> flags_of(const schema::Recording& recording) {
  const schema::Cycles& cycles = *recording.cycles;
  std::vector<FlaggedCycle> flagged =
      flagged_cycles(schema::RowsInMemory(recording), cycles, felt_along(recording.axes[cycles.axis]));
  if (recording.cycle_flags) add_what_was_said(flagged, *recording.cycle_flags);
  return flagged;
}

/// A sensor at its end is seen in what it said, not in what is left of that.
void add_clipped(std::vector<FlaggedCycle>& cycles, const std::vector<FlaggedCycle>& measured) {
  const auto is_clipped = [](const CycleFlag& flag) { return flag.fault == CycleFault::clipped; };
  for (std::size_t i = 0; i < std::min(cycles.size(), measured.size()); ++i) {
    std::erase_if(cycles[i].flags, is_clipped);
    std::ranges::copy_if(measured[i].flags, std::back_inserter(cycles[i].flags), is_clipped);
  }
}

/// Takes a blank off where that is asked for, and flags the cycles by what is left. Returns these, and the
/// recording as it was, if a blank was taken off.
std::vector<FlaggedCycle> less_the_blank(const RecordingStep& step, schema::Recording& recording,
                                         std::optional<schema::Recording>& before, StudiedRecording& result) {
  if (!recording.cycles) {
    if (step.blanks) result.blank.emplace().why_none = "it has no cycles";
    return {};
  }
  std::vector<FlaggedCycle> flagged = flags_of(recording);
  if (step.blanks) {
    before = recording;
    result.blank = take_blank_off(recording, *step.blanks, result.warnings);
    if (result.blank->is_taken()) {
      const std::vector<FlaggedCycle> measured = std::move(flagged);
      flagged = flags_of(recording);
      add_clipped(flagged, measured);
    } else {
      before.reset();
    }
  }
  recording.cycle_flags = stored_flags(flagged, felt_along(recording.axes[recording.cycles->axis]));
  if (before) before->cycle_flags = recording.cycle_flags;
  result.closing_direction = recording.cycles->closing_direction;
  return flagged;
}

/// What the sensor along which contact is told cannot say.
void take_sensor(const Inspection& inspection, StudiedRecording& result) {
  result.clipped_at = result.least_shown = std::numeric_limits<double>::quiet_NaN();
  for (const InspectedSignal& signal : inspection.signals) {
    if (!signal.tells_contact) continue;
    for (const EndOfRange& end : {signal.ends.least, signal.ends.most}) {
      if (!end.is_clipped.value_or(false)) continue;
      result.clipped_at = end.value;
      result.clipped_rows += end.rows;
    }
    if (signal.is_blind_at_zero()) result.least_shown = signal.facts.nearest_zero.value_or(0.0);
  }
}

void take_cycles(const std::vector<FlaggedCycle>& cycles, StudiedRecording& result) {
  for (const FlaggedCycle& cycle : cycles) {
    result.cycles.push_back({.number = cycle.facts.number,
                             .begin_s = cycle.facts.begin_s,
                             .closing_s = cycle.facts.closing_s,
                             .peak = cycle.facts.peak,
                             .closing_work = cycle.facts.closing_work,
                             .is_good = cycle.is_good(),
                             .reason = cycle.flags.empty() ? "" : reasons_of(cycle)});
  }
}

/// What it holds as it was measured.
void look_at_rows(const schema::Recording& recording, std::size_t axis, StudiedRecording& result) {
  const schema::RowsInMemory rows(recording);
  const schema::Axis& along = recording.axes[axis];
  const RowFigures figures = figures_of(rows);
  const ValueRange& positions = figures.columns.at(schema::Column::position).at(axis);
  result.rows = figures.rows;
  result.duration_s = figures.last_s - figures.first_s;
  result.period_s = figures.period_s;
  result.axis = along.name;
  result.position_unit = along.position_unit;
  result.force_unit = along.force_unit;
  result.travel = positions.max - positions.min;
  const Inspection inspection = inspect(rows, {.axis = axis, .felt = felt_along(along)});
  for (std::string& warning : warnings_of(inspection)) result.warnings.push_back(std::move(warning));
  take_sensor(inspection, result);
}

StudiedLaw studied(const RecordingFit& fit, const FittedLaw& law, const models::Options& asked) {
  const fitting::FitResult& found = law.result;
  StudiedLaw one{.model = found.model,
                 .free_parameters = found.free_parameters,
                 .rmse = found.rmse,
                 .held_out = found.held_out_rmse(),
                 .can_be_chosen = found.can_be_chosen(),
                 .within_jnd = found.can_be_chosen() && found.held_out_rmse() <= fit.jnd_n,
                 .blame = fit.blame(law),
                 .parameters = {}};
  for (const fitting::Estimate& estimate : found.parameters) {
    one.parameters.push_back(
        {.name = estimate.info.name,
         .unit = models::unit_of(estimate.info.quantity, law.file.force_unit, law.file.position_unit),
         .value = estimate.value,
         .std_error = estimate.std_error,
         .is_positive = estimate.info.lower >= 0.0});
  }
  for (const models::DataOption& option : models::law_facts(found.model).from_data) {
    const bool is_place = option.from == models::From::first || option.from == models::From::last ||
                          option.from == models::From::depth || option.from == models::From::speed;
    const std::string name(option.name);
    if (is_place && !asked.contains(name))
      one.taken_from_it[name] = std::get<double>(found.law_options.at(name));
  }
  return one;
}

FitRecordingOptions fit_options(const RecordingStep& step, const schema::Recording& recording,
                                std::size_t axis, const std::atomic<bool>& stop) {
  FitRecordingOptions options;
  options.models = step.plan->laws;
  options.law_options = step.plan->law_options;
  options.axis = axis;
  options.rows.cycles.by = step.plan->all_cycles ? CycleChoice::By::all : CycleChoice::By::good;
  options.stop = &stop;
  take_jnd_of(recording.axes[axis], options.fit);
  return options;
}

fs::path blank_taken(const RecordingStep& step, const StudiedRecording& result) {
  return std::ranges::find(step.blanks->all, result.blank->name, &StudyBlank::name)->recording;
}

void fit_laws(const RecordingStep& step, const schema::Recording& recording, const fs::path& folder,
              const FitRecordingOptions& options, StudiedRecording& result) {
  const std::size_t axis = options.axis;
  result.not_fitted = why_no_axis(recording, step.file->axis);
  if (!result.not_fitted.empty()) {
    result.axis.clear();
    return;
  }
  const FitSource source{.recording = &recording,
                         .name = "recording",
                         .axis = axis,
                         .contact = contact_of(recording, axis),
                         .not_the_tissue = result.not_the_tissue()};
  AxisSeries series;
  try {
    series = counted_series(source, options.rows, options.fit.jnd).series;
  } catch (const std::invalid_argument& error) {
    if (source.not_the_tissue.empty()) throw;
    result.not_fitted = error.what();
    return;
  }
  const fitting::Series counted = fitted_view(series);
  result.rms = fitting::rms_of(counted);
  result.jnd = options.fit.jnd.at(result.rms);
  for (std::size_t i = 0; i < series.force.size(); ++i)
    if (series.counts.empty() || series.counts[i] != 0) result.peak = std::max(result.peak, series.force[i]);
  if (step.file->blank) {
    result.not_fitted = "it is a blank";
    return;
  }
  result.not_fitted = nothing_felt(series, options.fit);
  if (!result.not_fitted.empty()) return;
  RecordingFit fit = fit_recordings(std::span(&source, 1), options);
  if (fit.laws.empty()) {
    result.not_fitted = fit.refusals.empty() ? "no law could be fitted" : fit.refusals.front().why;
    return;
  }
  fs::create_directory(folder / "fits");
  write_fits(fit, folder / "recording.h5", folder / "fits");
  for (const FittedLaw& law : fit.laws)
    result.laws.push_back(studied(fit, law, options_of_law(law.result.model, options.law_options)));
  result.floor = fit.floor ? fit.floor->velocity_n : std::numeric_limits<double>::quiet_NaN();
  result.chosen = fit.choice.model;
  result.why_chosen = fit.choice.why;
}

json as_json(const ImportFile& import) {
  const ImportOptions& options = import.options;
  return {{"map", import.map},
          {"sheet", options.sheet},
          {"stretch", options.stretch},
          {"rate", options.rate_hz},
          {"resample", options.resample_hz},
          {"velocity_window", options.velocity_window_s},
          {"origin", options.places.origin_m},
          {"point", options.places.point_m ? json(*options.places.point_m) : json(nullptr)},
          {"strict", options.strict}};
}

json as_json(const std::optional<StepJoin>& join) {
  if (!join) return nullptr;
  json all{{"source", sha256_of(join->source)}, {"import", as_json(join->import)}, {"on", join->on}};
  if (!join->marker.empty()) all["marker"] = join->marker;
  return all;
}

json as_json(const std::optional<StudyBlanks>& blanks) {
  if (!blanks) return nullptr;
  json all = json::array();
  for (const StudyBlank& blank : blanks->all) all.push_back({blank.name, blank.key});
  return all;
}

/// Blanks that were made already; one that was not could not be used.
StudyBlanks blanks_of(const StudyPlan& plan, const DrawerFile& file, const fs::path& folder) {
  const std::vector<std::string> names = recording_names(plan);
  StudyBlanks blanks;
  for (const std::size_t at : fitting_blanks(plan, file)) {
    StudyBlank blank{.name = names[at], .recording = {}, .key = ""};
    const fs::path place = folder / "recordings" / blank.name;
    try {
      const std::string key = key_of(step_of(plan, plan.files[at], folder));
      if (kept_recording(place, key))
        blank = {.name = names[at], .recording = place / "recording.h5", .key = key};
    } catch (const std::invalid_argument&) {
      blank.key.clear();  // its file is missing, or its import: that costs a line of its own
    }
    blanks.all.push_back(std::move(blank));
  }
  if (blanks.all.empty())
    blanks.why_none =
        fmt::format("no blank is of its speed{}{}{}", file.speed.empty() ? "" : ", " + file.speed,
                    file.rig.empty() ? "" : ", and rig, ", file.rig);
  return blanks;
}

}  // namespace

RecordingStep step_of(const StudyPlan& plan, const DrawerFile& file, const fs::path& folder) {
  RecordingStep step{.plan = &plan,
                     .file = &file,
                     .source = folder / "inputs" / fs::path(file.path),
                     .import = import_of(plan, file, folder)};
  if (!file.join.empty())
    step.join = {.name = file.join,
                 .source = folder / "inputs" / fs::path(file.join),
                 .import = import_named(file.join_map, plan, folder),
                 .on = file.join_on,
                 .marker = file.join_marker};
  step.shape = blade_file(plan, folder);
  if (plan.subtracts_blanks && !file.blank) step.blanks = blanks_of(plan, file, folder);
  return step;
}

std::string key_of(const RecordingStep& step) {
  const StudyPlan& plan = *step.plan;
  json all{{"result", first_result},         {"program", software()},     {"source", sha256_of(step.source)},
           {"import", as_json(step.import)}, {"laws", plan.laws},         {"all_cycles", plan.all_cycles},
           {"closing", plan.closing},        {"blank", step.file->blank}, {"join", as_json(step.join)},
           {"blanks", as_json(step.blanks)}};
  if (!plan.law_options.empty()) all["law_options"] = plan.law_options;
  if (!step.file->axis.empty()) all["axis"] = step.file->axis;
  if (!step.shape.empty()) all["shape"] = sha256_of(step.shape);
  return sha256_of(std::string_view(all.dump()));
}

StudiedRecording run_recording_step(const RecordingStep& step, const fs::path& folder,
                                    const std::atomic<bool>& stop) {
  StudiedRecording result;
  result.key = key_of(step);
  schema::Recording recording = imported_or_read(step, result);
  find_cycles_of(step, recording, result);
  const std::size_t axis = find_cut_axis(recording, step.file->axis);
  look_at_rows(recording, axis, result);
  std::optional<schema::Recording> before;
  take_cycles(less_the_blank(step, recording, before, result), result);
  result.content = content_sha256_of(schema::RowsInMemory(recording));
  schema::write_recording(folder / "recording.h5", recording, schema::Existing::replace);
  const FitRecordingOptions options = fit_options(step, recording, axis, stop);
  fit_laws(step, recording, folder, options, result);
  if (before)
    result.blank->without = without_parts(
        {.recording = &*before, .blank = blank_taken(step, result), .axis = axis, .options = options}, result,
        step.plan->all_cycles);
  if (!step.file->blank) result.blade = fit_blade_in_study(recording, step.shape, folder, result.warnings);
  write_json_file(folder / "result.json", as_json(result));
  return result;
}

}  // namespace kerf::bench
