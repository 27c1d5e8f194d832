#include "results/result_jobs.h"

#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "chart/chart_files.h"
#include "choose/choice_files.h"
#include "choose/choose_on_device.h"
#include "fits/fit_files.h"
#include "fits/fit_series.h"
#include "host/realtime.h"
#include "laws/render.h"
#include "recordings/axes.h"
#include "results/result_folder.h"

namespace kerf::bench {
namespace {

std::string run_fit(Workspace& workspace, const FitRequest& request, JobProgress& progress) {
  const schema::Recording recording = schema::read_recording(request.recording.path);
  const FitSource source = source_of(request.asked, recording, request.recording.path.stem().string());
  FitRecordingOptions options = options_of(request.asked, source);
  options.stop = &progress.stop;
  options.done = &progress.done;
  options.fit.threads = usable_processors();
  progress.steps = steps_of(options);
  RecordingFit fit = fit_recordings(std::span(&source, 1), options);
  if (fit.laws.empty()) {
    const std::string reason = fit.refusal();
    throw std::invalid_argument(reason.empty() ? "no law could be fitted" : reason);
  }
  ResultFolder folder(workspace, result_stem(request.recording.name), ".fit");
  write_fits(fit, request.recording.path, folder.path());
  return folder.publish(workspace, "fit.json");
}

std::string run_chart(Workspace& workspace, const ChartRequest& request, JobProgress& progress) {
  const schema::Recording recording = schema::read_recording(request.recording.path);
  ChartOptions options{.models = request.models};
  options.threads = usable_processors();
  options.stop = &progress.stop;
  options.done = &progress.done;
  const FitSource source = charted(recording, request.recording.path.stem().string(), request.axis);
  const schema::Axis& axis = recording.axes[source.axis];
  options.jnd = fitting::jnd_of(axis.force_unit, axis.lever);
  SpeedAccuracy chart = chart_recording(source, options);
  if (chart.stopped) throw std::runtime_error("stopped");
  chart.notes.emplace_back(
      "costs were measured beside a running studio, which makes their 99.9th percentiles larger than they "
      "are in a loop of their own; 'kerf chart' measures them in peace");
  ResultFolder folder(workspace, result_stem(request.recording.name), ".chart");
  write_chart(chart, folder.path());
  return folder.publish(workspace, "chart.json");
}

std::string run_choice(Workspace& workspace, const ChoiceRequest& request, JobProgress& progress) {
  const schema::Recording recording = schema::read_recording(request.recording.path);
  DeviceChoiceOptions options{
      .loop = {.rate_hz = request.rate_hz}, .tried_by = TriedBy::virtual_time, .begins = {}};
  options.choose.axis = find_cut_axis(recording, request.axis);
  take_jnd_of(recording.axes[options.choose.axis], options.choose.fit);
  options.choose.candidates.max_segments = request.max_segments;
  options.choose.threads = usable_processors();
  options.choose.done = &progress.done;
  options.choose.of = &progress.steps;
  DeviceChoice made = choose_on_device(recording, request.recording.path, std::move(options), progress.stop);
  made.json["recording"] = request.recording.name;  // as the workspace knows it
  ResultFolder folder(workspace, result_stem(request.recording.name), ".choice");
  write_choice(made.choice, made.json, request.recording.path, folder.path());
  return folder.publish(workspace, "choose.json");
}

std::string run_stability(Workspace& workspace, StabilityRequest request, JobProgress& progress) {
  StudyOptions& study = request.study;
  study.map.threads = usable_processors();
  study.map.stop = &progress.stop;
  study.map.done = &progress.done;
  progress.steps = study.cells;
  Findings findings;
  if (request.law) {
    findings = study_law(read_law_file(request.law->path), request.law->name, study).findings;
    findings.json["law_file"] = request.law->name;
  } else {
    findings = study_walls(study);
  }
  const std::string stem = result_stem(request.law ? request.law->name : study.on.device_uri);
  ResultFolder folder(workspace, stem, ".stability");
  write_findings(findings, folder.path());
  return folder.publish(workspace, "stability.json");
}

}  // namespace

JobOrder fit_job(Workspace& workspace, FitRequest request) {
  return {.kind = "fit",
          .title = fmt::format("Fit of {}", request.recording.name),
          .work = [&workspace, request = std::move(request)](JobProgress& progress) {
            return run_fit(workspace, request, progress);
          }};
}

JobOrder chart_job(Workspace& workspace, ChartRequest request) {
  return {.kind = "chart",
          .title = fmt::format("Chart of {}", request.recording.name),
          .steps = chart_steps,
          .work = [&workspace, request = std::move(request)](JobProgress& progress) {
            return run_chart(workspace, request, progress);
          }};
}

JobOrder choice_job(Workspace& workspace, ChoiceRequest request) {
  return {.kind = "choice",
          .title = fmt::format("Choice for {}", request.recording.name),
          .work = [&workspace, request = std::move(request)](JobProgress& progress) {
            return run_choice(workspace, request, progress);
          }};
}

JobOrder stability_job(Workspace& workspace, StabilityRequest request) {
  return {
      .kind = "stability",
      .title = fmt::format("Stability of {}", request.law ? request.law->name : request.study.on.device_uri),
      .work = [&workspace, request = std::move(request)](JobProgress& progress) {
        return run_stability(workspace, request, progress);
      }};
}

}  // namespace kerf::bench
