#include "chart/speed_accuracy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "chart/fidelities.h"
#include "chart/fit_plan.h"
#include "chart/fronts.h"
#include "chart/reference_forces.h"
#include "fits/fit_series.h"
#include "fits/law_options.h"
#include "laws/placement.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_fit_samples = 4000;
constexpr std::size_t scene_timed_from = 300;  // of the chart's steps

/// The motion along the path, by rate, each made once.
class Motions {
 public:
  explicit Motions(const ScriptedPath& path) : path_(path) {}
  const SampledMotion& at(double rate_hz) {
    const auto known = of_rate_.find(rate_hz);
    if (known != of_rate_.end()) return known->second;
    return of_rate_.emplace(rate_hz, path_.at(rate_hz)).first->second;
  }

 private:
  const ScriptedPath& path_;
  std::map<double, SampledMotion> of_rate_;
};

/// What the reference of a law along one axis looks like to a fit. A cycle begins where the tool turns
/// inwards.
AxisSeries reference_series(const LawFile& law, const ReferenceForces& reference, const SampledMotion& path) {
  const std::size_t axis = reference.axes().front();
  const std::size_t step = path.ticks() / max_fit_samples + 1;
  AxisSeries series;
  std::uint32_t number = 0;
  bool inwards = false;
  for (std::size_t i = 0; i < path.ticks(); i += step) {
    const auto& [position, velocity] = path.sample[i];
    const models::Motion motion = law.contact.motion(position[axis], velocity[axis]);
    if (motion.velocity > 0.0 && !inwards) ++number;
    if (motion.velocity != 0.0) inwards = motion.velocity > 0.0;
    series.time_s.push_back(path.time_s[i]);
    series.penetration.push_back(motion.penetration);
    series.velocity.push_back(motion.velocity);
    series.force.push_back(resisting(reference.force_n(0, series.time_s.back()), false, law.contact));
    series.cycle.push_back(number);
  }
  return series;
}

ChartPoint point_of(const Fidelity& fidelity) {
  return {.law = std::string(fidelity.law.law.model()),
          .fidelity = fidelity.label,
          .parameters = fidelity.law.law.values().size(),
          .rate_hz = fidelity.rate_hz,
          .cost = {},
          .axis = {},
          .stability = {},
          .file = fidelity.law};
}

/// What a law with two branches is rendered with, if it says nothing of that itself.
void add_aids(LawFile& file, const SampledMotion& path, std::size_t axis) {
  for (const auto* aid : {"velocity_corner", "ramp_band", "reversal_scale"}) {
    if (file.law.options().count(aid) > 0) return;
  }
  AxisSeries met;
  for (const auto& [position, velocity] : path.sample) {
    const models::Motion motion = file.contact.motion(position[axis], velocity[axis]);
    met.penetration.push_back(motion.penetration);
    met.velocity.push_back(motion.velocity);
  }
  file = with_options(file, with_rendering_aids(file.law.options(), met));
}

/// The other laws, as fitted to the reference of this one.
void add_fitted(const LawFile& law, const AxisSeries& series, const ChartOptions& options,
                SpeedAccuracy& chart) {
  const auto plans = fit_plans(options.models);
  for (const FitPlan& plan : plans) {
    if (options.stopped()) return;
    const bool fits = units_fit(models::law_info(plan.model), law.position_unit, law.force_unit);
    if (plan.model == law.law.model() || !fits) continue;
    try {
      fitting::FitOptions fit{.law_options = plan.options, .jnd = options.jnd, .folds = 0};
      fit.intervals = fitting::Intervals::white;
      const fitting::FitResult result = fitting::fit(plan.model, fitted_view(series), fit);
      if (result.parameters.empty()) throw std::invalid_argument(result.message);
      ChartPoint point = point_of({plan.label, with_law(law, result.law()), options.rate_hz});
      point.parameters = result.free_parameters;
      chart.points.push_back(point);
    } catch (const std::invalid_argument& error) {
      chart.notes.push_back(fmt::format("{} ({}) was not fitted: {}", plan.model, plan.label, error.what()));
    }
    if (options.done != nullptr) *options.done += scene_timed_from / plans.size();
  }
}

void time_points(const std::vector<std::size_t>& axes, Motions& motions, const ChartOptions& options,
                 SpeedAccuracy& chart) {
  std::vector<TimedLaw> laws;
  for (const ChartPoint& point : chart.points) {
    laws.push_back({.rendering = LawRendering(point.file.law, point.file.contact, axes),
                    .path = &motions.at(point.rate_hz)});
  }
  chart.stopped = !measure_costs(chart, laws, options, scene_timed_from);
}

/// How far the refinements of a law are from the reference, which is the last of them.
Convergence convergence_along(const Fidelities& fidelities, const ReferenceForces& reference,
                              Motions& motions, const ChartOptions& options) {
  std::vector<Refinement> refinements;
  for (const auto& [factor, fidelity] : fidelities.refinements) {
    if (options.stopped()) return {};
    ChartPoint point = point_of(fidelity);
    reference.compare(render(fidelity.law, reference.axes(), motions.at(fidelity.rate_hz)), point);
    refinements.push_back({fidelity.label, factor, point.error_jnd});
  }
  return convergence_of(std::move(refinements));
}

}  // namespace

bool within_jnd(const ChartPoint& point) noexcept {
  return point.error_jnd <= 1.0 && point.jnd_fraction <= jnd_fraction_limit;
}

void judge_stability(ChartPoint& point, const ChartOptions& options) {
  point.stability =
      options.stability
          ? options.stability(point.file, point.rate_hz)
          : not_judged("no hand pressed and held it; its forces along the path do not run away");
}

ScriptedPath scripted_path(const Scene& scene) {
  const auto device = drivers::open_device(device_of(scene));
  const bool ends = std::isfinite(scene.tissue_until) && !scene.tissue.law.is_spatial();
  const std::size_t axis = ends ? axis_for(scene.tissue, device->info()) : 0;
  return {.device = device->info(), .at = [scene, ends, axis](double rate_hz) {
            SampledMotion path = tool_path(scene, rate_hz);
            const models::Contact& contact = scene.tissue.contact;
            for (models::SpatialMotion& sample : path.sample) {
              if (!ends) break;
              if (contact.motion(sample.position[axis], 0.0).penetration < scene.tissue_until) continue;
              sample.position[axis] = contact.position + contact.direction * scene.tissue_until;
              sample.velocity[axis] = 0.0;
            }
            return path;
          }};
}

SpeedAccuracy chart_scene(const LawFile& law, const ScriptedPath& path, const ChartOptions& options) {
  const Fidelities fidelities = fidelities_of(law, options.rate_hz);
  const ReferenceForces reference(fidelities.reference, path, axes_for(law, path.device), options.jnd);
  SpeedAccuracy chart{.source = {},
                      .reference = fmt::format("{}, {} at {:g} Hz", law.law.model(),
                                               fidelities.reference.label, fidelities.reference.rate_hz),
                      .rate_hz = options.rate_hz,
                      .jnd_n = reference.jnd_n(0),
                      .one_axis = reference.axes().size() == 1,
                      .points = {},
                      .notes = fidelities.notes};
  Motions motions(path);
  chart.convergence = convergence_along(fidelities, reference, motions, options);
  for (const Fidelity& fidelity : fidelities.all) chart.points.push_back(point_of(fidelity));
  if (!law.law.is_spatial()) {
    const AxisSeries series = reference_series(law, reference, motions.at(options.rate_hz));
    add_fitted(law, series, options, chart);
  } else if (!options.models.empty()) {
    chart.notes.push_back(
        fmt::format("other laws are not fitted to law '{}', which has axes of its own", law.law.model()));
  }
  for (ChartPoint& point : chart.points) {
    if (options.stopped()) break;
    reference.compare(render(point.file, reference.axes(), motions.at(point.rate_hz)), point);
    if (!law.law.is_spatial()) add_aids(point.file, motions.at(options.rate_hz), reference.axes().front());
    if (point.stability.stable != Stable::no) judge_stability(point, options);
  }
  if (!options.stopped()) time_points(reference.axes(), motions, options, chart);
  chart.stopped = chart.stopped || options.stopped();
  if (chart.stopped) {
    chart.points.clear();
    return chart;
  }
  mark_fronts(chart);
  if (options.done != nullptr) *options.done = chart_steps;
  if (chart.one_axis) return chart;
  const auto worst = std::max_element(chart.points.begin(), chart.points.end(),
                                      [](const auto& a, const auto& b) { return a.error_jnd < b.error_jnd; });
  chart.jnd_n = reference.jnd_of(worst->axis);
  return chart;
}

}  // namespace kerf::bench
