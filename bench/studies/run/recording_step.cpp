#include "run/recording_step.h"

#include <algorithm>
#include <cmath>
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
#include "fits/row_doubts.h"
#include "import/import.h"
#include "inspect/flagged_cycles.h"
#include "inspect/inspection.h"
#include "recordings/axes.h"
#include "recordings/provenance.h"
#include "recordings/row_figures.h"
#include "recordings/whole_recording.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* first_result = "1";  // of what result.json holds: a number more makes all anew

schema::Recording imported_or_read(const RecordingStep& step, StudiedRecording& result) {
  if (step.source.extension() == ".h5") return read_whole_recording(step.source);
  if (step.import.map.empty())
    throw std::invalid_argument("its columns are unknown: give it, or the study, a map");
  Imported imported = import_text(step.source, step.import.options);
  result.warnings = std::move(imported.warnings);
  return std::move(imported.recording);
}

double felt_along(const schema::Axis& axis) { return fitting::jnd_of(axis.force_unit, axis.lever).threshold; }

/// Cycles that the recording has stay, with what a person said of them.
void find_and_flag(const RecordingStep& step, schema::Recording& recording, StudiedRecording& result) {
  const schema::RowsInMemory rows(recording);
  if (!recording.cycles) {
    SegmentOptions options;
    if (!step.plan->closing.empty())
      options.closing_direction = step.plan->closing == "increasing" ? 1.0 : -1.0;
    try {
      segment_recording(recording, rows, options, step.file->path);
    } catch (const std::invalid_argument& error) {
      result.warnings.push_back(fmt::format("it has no cycles: {}", error.what()));
      return;
    }
  }
  const schema::Cycles& cycles = *recording.cycles;
  const double felt = felt_along(recording.axes[cycles.axis]);
  std::vector<FlaggedCycle> flagged = flagged_cycles(rows, cycles, felt);
  if (recording.cycle_flags) add_what_was_said(flagged, *recording.cycle_flags);
  recording.cycle_flags = stored_flags(flagged, felt);
  result.closing_direction = cycles.closing_direction;
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

void take_cycles(const Inspection& inspection, StudiedRecording& result) {
  for (const FlaggedCycle& cycle : inspection.cycles.cycles) {
    result.cycles.push_back({.number = cycle.facts.number,
                             .begin_s = cycle.facts.begin_s,
                             .closing_s = cycle.facts.closing_s,
                             .peak = cycle.facts.peak,
                             .closing_work = cycle.facts.closing_work,
                             .is_good = cycle.is_good(),
                             .reason = cycle.flags.empty() ? "" : reasons_of(cycle)});
  }
}

void look_at_rows(const schema::Recording& recording, std::size_t axis, StudiedRecording& result) {
  const schema::RowsInMemory rows(recording);
  const schema::Axis& along = recording.axes[axis];
  const RowFigures figures = figures_of(rows);
  const ValueRange& positions = figures.columns.at(schema::Column::position).at(axis);
  result.content = content_sha256_of(rows);
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
  take_cycles(inspection, result);
}

StudiedLaw studied(const RecordingFit& fit, const FittedLaw& law) {
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
  return one;
}

void fit_laws(const RecordingStep& step, const schema::Recording& recording, const fs::path& folder,
              std::size_t axis, const std::atomic<bool>& stop, StudiedRecording& result) {
  FitRecordingOptions options;
  options.models = step.plan->laws;
  options.axis = axis;
  options.rows.cycles.by = step.plan->all_cycles ? CycleChoice::By::all : CycleChoice::By::good;
  options.stop = &stop;
  take_jnd_of(recording.axes[axis], options.fit);
  const FitSource source{
      .recording = &recording, .name = "recording", .axis = axis, .contact = contact_of(recording, axis)};
  const AxisSeries series = counted_series(source, options.rows, options.fit.jnd).series;
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
  for (const FittedLaw& law : fit.laws) result.laws.push_back(studied(fit, law));
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

}  // namespace

std::string key_of(const RecordingStep& step) {
  const StudyPlan& plan = *step.plan;
  const json all{
      {"result", first_result},         {"program", software()},    {"source", sha256_of(step.source)},
      {"import", as_json(step.import)}, {"laws", plan.laws},        {"all_cycles", plan.all_cycles},
      {"closing", plan.closing},        {"blank", step.file->blank}};
  return sha256_of(std::string_view(all.dump()));
}

StudiedRecording run_recording_step(const RecordingStep& step, const fs::path& folder,
                                    const std::atomic<bool>& stop) {
  StudiedRecording result;
  result.key = key_of(step);
  schema::Recording recording = imported_or_read(step, result);
  find_and_flag(step, recording, result);
  const std::size_t axis = find_cut_axis(recording, "");
  look_at_rows(recording, axis, result);
  schema::write_recording(folder / "recording.h5", recording, schema::Existing::replace);
  fit_laws(step, recording, folder, axis, stop, result);
  write_json_file(folder / "result.json", as_json(result));
  return result;
}

}  // namespace kerf::bench
