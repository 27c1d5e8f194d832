#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/fitting/fit.h>

#include "fits/fit_recording.h"
#include "fits/fit_series.h"
#include "laws/render.h"
#include "recordings/axes.h"
#include "recordings/whole_recording.h"
#include "verbs/parameter_columns.h"
#include "verbs/sweep_verb.h"
#include "verbs/swept_recording.h"

namespace kerf::bench {
namespace {

std::vector<SweepInput> inputs_of_fits() {
  using enum SweepInput::Kind;
  std::vector<std::string> laws;
  for (const std::string_view law : fitting::fitted_laws()) laws.emplace_back(law);
  std::vector<SweepInput> inputs = recording_inputs("to fit");
  inputs.insert(inputs.end(),
                {{.name = "law", .kind = text, .what = "Law", .among = laws, .required = true},
                 {.name = "option", .kind = text, .what = "NAME=VALUE of the law", .standard = ""},
                 {.name = "segments",
                  .kind = whole,
                  .what = "Segments of the piecewise law",
                  .lower = 1,
                  .upper = 16,
                  .standard = 5.0},
                 {.name = "folds",
                  .kind = whole,
                  .what = "Folds of the cross-validation; 0: none",
                  .lower = 0,
                  .upper = 100,
                  .standard = 5.0},
                 {.name = "rate",
                  .what = "Rate of the loop that errors as rendered are of",
                  .unit = "Hz",
                  .lower = 100,
                  .upper = 10000,
                  .standard = 1000.0},
                 {.name = "confidence",
                  .what = "Confidence of the intervals",
                  .lower = 0.5,
                  .upper = 0.9999,
                  .standard = 0.95}});
  for (SweepInput& input : noise_inputs()) inputs.push_back(std::move(input));
  return inputs;
}

CellNumbers numbers_of(const RecordingFit& fit) {
  const fitting::FitResult& result = fit.laws.front().result;
  const std::string& force_unit = fit.laws.front().file.force_unit;
  CellNumbers numbers{.table = result.model, .columns = {}, .values = {}};
  numbers.add("converged", "1", result.converged ? 1.0 : 0.0);
  numbers.add("counted", "1", static_cast<double>(fit.recordings.front().counted));
  numbers.add("rmse", force_unit, result.rmse);
  numbers.add("rmse_rendered", force_unit, result.rendered.rmse);
  numbers.add("max_abs", force_unit, result.max_abs);
  numbers.add("r2", "1", result.r2);
  numbers.add("cv_rmse", force_unit, result.cv_rmse);
  numbers.add("cv_rmse_rendered", force_unit, result.rendered.cv_rmse);
  numbers.add("line_rmse", force_unit, fit.line_rmse_n);
  numbers.add("jnd", force_unit, fit.jnd_n);
  numbers.add("jnd_fraction", "1", result.jnd_fraction);
  numbers.add("bic", "1", result.bic);
  numbers.add("effective_samples", "1", result.effective_samples);
  numbers.add("correlation_time", "samples", result.correlation_time);
  numbers.add("iterations", "1", result.iterations);
  add_parameters(numbers, fit.laws.front());
  return numbers;
}

class FitCells final : public CellWork {
 public:
  explicit FitCells(const std::filesystem::path& folder) : recording_(folder, read_fitted_columns) {}

  CellNumbers compute(const SweepCell& cell) override {
    const schema::Recording& recording = recording_.of(cell);
    FitRecordingOptions options;
    options.models = {cell.text("law")};
    options.axis = find_axis(recording, cell.text("axis"));
    options.segments = static_cast<std::size_t>(cell.number("segments"));
    if (!cell.text("option").empty()) options.law_options = {cell.text("option")};
    options.rows = {.rows = cell.text("rows") == "all" ? Counted::all : Counted::contact,
                    .cycles = parse_cycle_choice(cell.text("cycles"))};
    options.loop_rate_hz = cell.number("rate");
    options.floor = false;
    options.fit.folds = static_cast<std::size_t>(cell.number("folds"));
    options.fit.confidence = cell.number("confidence");
    take_jnd_of(recording.axes[options.axis], options.fit);
    options.contact = contact_of(recording, options.axis);
    const RecordingFit fit = fit_recording(recording, options);
    if (fit.laws.empty())
      throw std::invalid_argument(fit.refusals.empty() ? "no law could be fitted" : fit.refusals.front().why);
    return numbers_of(fit);
  }

 private:
  SweptRecording recording_;
};

}  // namespace

const SweepVerb sweep_of_fits{.name = "fit",
                              .what = "fits a law to a recording, as 'kerf fit' does",
                              .inputs = inputs_of_fits,
                              .begin = [](const SweepPlan& plan) -> std::unique_ptr<CellWork> {
                                return std::make_unique<FitCells>(plan.folder);
                              }};

}  // namespace kerf::bench
