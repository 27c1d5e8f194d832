#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "chart/cost/timed_stretch.h"
#include "chart/fidelities.h"
#include "chart/fit_plan.h"
#include "chart/fronts.h"
#include "chart/speed_accuracy.h"
#include "fits/rendered_series.h"
#include "fits/row_doubts.h"
#include "inspect/counted_rows.h"
#include "recordings/axes.h"
#include "recordings/axis_series.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr std::size_t recording_timed_from = 700;  // of the chart's steps
constexpr double runaway = 10.0;                   // times the largest force recorded

FitRecordingOptions options_of(const FitPlan& plan, const ChartOptions& options) {
  FitRecordingOptions fit{.models = {plan.model}};
  fit.rows = options.rows;
  fit.fit.law_options = plan.options;
  fit.fit.folds = options.folds;
  fit.fit.threads = options.threads;
  fit.loop_rate_hz = options.rate_hz;
  fit.floor = false;
  fit.fit.jnd = options.jnd;
  fit.fit.intervals = fitting::Intervals::white;
  return fit;
}

std::size_t most_segments(const std::vector<FitPlan>& plans) {
  double most = 1.0;
  for (const FitPlan& plan : plans) {
    const models::LawFacts& facts = models::law_facts(plan.model);
    if (facts.search != models::Search::segments) continue;
    const auto told = plan.options.find(facts.size.option);
    if (told != plan.options.end()) most = std::max(most, std::get<double>(told->second));
  }
  return static_cast<std::size_t>(most);
}

/// Root mean square and largest difference of two series of forces, in their unit.
struct Difference {
  double rms_n = 0.0;
  double largest_n = 0.0;
};

Difference difference(const std::vector<double>& a, const std::vector<double>& b) {
  Difference result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    result.rms_n += (a[i] - b[i]) * (a[i] - b[i]);
    result.largest_n = std::max(result.largest_n, std::abs(a[i] - b[i]));
  }
  result.rms_n = std::sqrt(result.rms_n / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
  return result;
}

/// The force to be charted, row by row, with the rows marked that count.
CountedSeries charted_series(const FitSource& source, const ChartOptions& options) {
  CountedSeries made = counted_series(source, options.rows, options.jnd);
  if (made.series.time_s.size() < 2) throw std::invalid_argument("a recording of one row cannot be charted");
  return made;
}

class RecordingChart {
 public:
  RecordingChart(const FitSource& source, const ChartOptions& options)
      : RecordingChart(source, options, charted_series(source, options)) {}

  RecordingChart(const FitSource& source, const ChartOptions& options, CountedSeries made)
      : source_(source),
        options_(options),
        series_(std::move(made.series)),
        in_the_loop_(series_, options.rate_hz) {
    options_.rows.cycles = made.counted.none_is_good ? CycleChoice{.by = CycleChoice::By::all}
                                                     : settled(options.rows.cycles, *source.recording,
                                                               source.axis, options.jnd.threshold);
    chart_.cycles = options.rows.cycles;
    if (std::string left_out = cycles_left_out(made.counted); !left_out.empty())
      chart_.notes.push_back(std::move(left_out));
    chart_.cycles_left_out = std::move(made.counted.left_out);
    period_s_ = median_period(series_.time_s);
    for (const double force : series_.force) peak_n_ = std::max(peak_n_, std::abs(force));
  }

  SpeedAccuracy run() {
    chart_.source = source_.name;
    chart_.recording = source_.recording->header.uuid;
    chart_.of_recording = kept_state(*source_.recording, source_.axis);
    chart_.contact = source_.contact;
    chart_.rate_hz = options_.rate_hz;
    chart_.force_unit = source_.recording->axes[source_.axis].force_unit;
    chart_.reference = options_.folds > 0
                           ? "held-out cycles, or blocks of time where there are none, as rendered"
                           : "the recording itself, with nothing held out, as rendered";
    const auto plans = fit_plans(options_.models);
    memory_ = fitting::remember_segments(most_segments(plans));
    for (const FitPlan& plan : plans) {
      if (options_.stopped()) break;
      add(plan);
      if (options_.done != nullptr) *options_.done += recording_timed_from / plans.size();
    }
    if (!options_.stopped() && chart_.points.empty()) refuse();
    if (!options_.stopped()) time();
    if (chart_.stopped || options_.stopped()) {
      chart_.stopped = true;
      chart_.points.clear();
      return chart_;
    }
    mark_fronts(chart_);
    if (options_.done != nullptr) *options_.done = chart_steps;
    return chart_;
  }

 private:
  void add(const FitPlan& plan) {
    FitRecordingOptions options = options_of(plan, options_);
    options.fit.segmented_memory = memory_;
    const RecordingFit fit = fit_recordings(std::span(&source_, 1), options);
    for (const Refusal& refusal : fit.refusals) {
      chart_.notes.push_back(
          fmt::format("{} ({}) was not fitted: {}", refusal.model, plan.label, refusal.why));
    }
    if (fit.laws.empty()) return;
    const FittedLaw& fitted = fit.laws.front();
    chart_.jnd_n = fit.jnd_n;
    const auto rendered_force = render(fitted.file.law, series_);
    ChartPoint point{
        .law = plan.model,
        .fidelity = plan.label,
        .parameters = fitted.result.free_parameters,
        .rate_hz = chart_.rate_hz,
        .cost = {},
        .error_n = options_.folds > 0 ? fitted.result.held_out_rmse() : fitted.result.rendered.rmse,
        .worst_n = difference(rendered_force, series_.force).largest_n,
        .axis = source_.recording->axes[source_.axis].name,
        .stability = {},
        .file = fitted.file,
        .fit = std::make_shared<fitting::FitResult>(fitted.result)};
    point.jnd_fraction = share_outside(fitted.file.law);
    if (!std::isfinite(point.error_n)) {
      chart_.notes.push_back(
          fmt::format("{} ({}) has no error on held-out data and is left out", plan.model, plan.label));
      return;
    }
    finish(point, rendered_force);
    const bool first = chart_.points.size() == 1 || chart_.points[chart_.points.size() - 2].law != plan.model;
    if (has_float(plan.model) && first) add_single(plan, point, rendered_force);
  }

  /// Share of the rows in contact where the error of the law, as a loop renders it, could be felt.
  [[nodiscard]] double share_outside(const models::Law& law) const {
    const std::vector<double> force = in_the_loop_.force(law);
    double rows = 0.0;
    double felt = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (!series_.counts.empty() && series_.counts[i] == 0) continue;
      rows += 1.0;
      if (!(std::abs(force[i] - series_.force[i]) <= options_.jnd.at(series_.force[i]))) felt += 1.0;
    }
    return felt / std::max(rows, 1.0);
  }

  void add_single(const FitPlan& plan, ChartPoint point, const std::vector<double>& in_double) {
    try {
      point.file = with_options(point.file, {{"precision", std::string("float")}});
    } catch (const std::invalid_argument& error) {
      chart_.notes.push_back(fmt::format("{} ({}) in float: {}", plan.model, plan.label, error.what()));
      return;
    }
    const auto in_single = render(point.file.law, series_);
    point.fidelity += ", float";
    point.jnd_fraction = share_outside(point.file.law);
    point.error_n = std::hypot(point.error_n, difference(in_single, in_double).rms_n);
    finish(point, in_single);
  }

  void finish(ChartPoint& point, const std::vector<double>& force) {
    point.error_jnd = point.error_n / chart_.jnd_n;
    double largest = 0.0;
    bool finite = true;
    for (const double f : force) {
      largest = std::max(largest, std::abs(f));
      finite = finite && std::isfinite(f);
    }
    if (!finite || !(largest <= runaway * peak_n_)) {
      point.stability = not_stable(fmt::format("its force reaches {:.3g} {unit}, the recording {:.3g} {unit}",
                                               largest, peak_n_, fmt::arg("unit", chart_.force_unit)));
    } else {
      judge_stability(point, options_);
    }
    chart_.points.push_back(point);
  }

  void time() {
    SampledMotion stretch = timed_stretch(series_, period_s_);
    for (auto& at : stretch.sample) {
      at.position[0] = source_.contact.position + source_.contact.direction * at.position[0];
      at.velocity[0] *= source_.contact.direction;
    }
    std::vector<TimedLaw> laws;
    for (const ChartPoint& point : chart_.points) {
      laws.push_back({.rendering = LawRendering(point.file.law, point.file.contact, {0}), .path = &stretch});
    }
    chart_.stopped = !measure_costs(chart_, laws, options_, recording_timed_from);
  }

  [[noreturn]] void refuse() const {
    throw std::invalid_argument(chart_.notes.empty() ? "no law could be fitted"
                                                     : "no law could be fitted: " + chart_.notes.front());
  }

  const FitSource& source_;
  ChartOptions options_;  ///< with the cycles by number
  AxisSeries series_;
  RenderedSeries in_the_loop_;
  double period_s_ = 0.0;
  double peak_n_ = 0.0;
  std::shared_ptr<fitting::SegmentedMemory> memory_;
  SpeedAccuracy chart_;
};

}  // namespace

FitSource charted(const schema::Recording& recording, const std::string& name, const std::string& axis) {
  const std::size_t place = find_cut_axis(recording, axis);
  return {.recording = &recording, .name = name, .axis = place, .contact = contact_of(recording, place)};
}

SpeedAccuracy chart_recording(const FitSource& source, const ChartOptions& options) {
  return RecordingChart(source, options).run();
}

}  // namespace kerf::bench
