#include "page/study_charts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <kerf/fitting/fit.h>

#include "fits/fit_recording.h"
#include "fits/fit_series.h"
#include "fits/row_doubts.h"
#include "laws/render.h"
#include "recordings/axes.h"
#include "recordings/whole_recording.h"
#include "report/charts.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_points = 1500;  // of a small chart
constexpr double point_size = 1.6;
constexpr double value_size = 5.0;

/// From the least to the most value and a share of that beyond, so that no point lies on the frame. Empty of
/// fewer than two.
Range with_margins(const std::vector<Curve>& curves) {
  constexpr double margin = 0.03;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const Curve& curve : curves) {
    for (const double x : curve.x) {
      if (!std::isfinite(x)) continue;
      least = std::min(least, x);
      most = std::max(most, x);
    }
  }
  if (!(least < most)) return {};
  return {least - margin * (most - least), most + margin * (most - least)};
}

/// Rows of the recording's cycles that are flagged.
std::vector<std::uint32_t> flagged_numbers(const DrawerRecording& recording) {
  std::vector<std::uint32_t> numbers;
  for (const StudiedCycle& cycle : recording.result.cycles)
    if (!cycle.is_good) numbers.push_back(cycle.number);
  return numbers;
}

/// Whether a row of a series is among those from which a blank was taken; empty: none was to be.
std::vector<std::uint8_t> covered_rows(const DrawerRecording& drawn, FitSource source, AxisSeries series) {
  source.not_the_tissue = drawn.result.not_the_tissue();
  if (source.not_the_tissue.empty()) return {};
  RowChoice all{.rows = Counted::all};
  all.cycles.by = CycleChoice::By::all;
  try {
    mark_rows(source, all, 0.0, series);
  } catch (const std::invalid_argument&) {
    series.counts.assign(series.force.size(), 0);  // so few that none is fitted to
  }
  return series.counts;
}

}  // namespace

Chart drawer_chart(const DrawerRecording& drawn, const StudyPlan& plan, const std::filesystem::path& folder) {
  const schema::Recording recording =
      read_whole_recording(folder / "recordings" / drawn.name / "recording.h5");
  const std::size_t axis = find_cut_axis(recording, "");
  const DrawnUnit unit = drawn_position(recording.axes[axis]);
  const models::Contact contact = contact_of(recording, axis);
  const AxisSeries whole = fit_series(recording, axis, contact);
  fitting::FitOptions fit;
  take_jnd_of(recording.axes[axis], fit);
  const FitSource source{.recording = &recording, .name = "", .axis = axis, .contact = contact};
  RowChoice all_cycles;
  all_cycles.cycles.by = CycleChoice::By::all;
  const AxisSeries counted = counted_series(source, all_cycles, fit.jnd).series;
  const std::vector<std::uint8_t> covered = covered_rows(drawn, source, whole);
  const std::vector<std::uint32_t> flagged = flagged_numbers(drawn);
  Curve idle{.label = "idle", .colour = Colour::sky, .mark = Mark::points, .width = point_size};
  Curve bad{.label = "flagged", .colour = Colour::vermillion, .mark = Mark::points, .width = point_size};
  Curve beyond{
      .label = "no blank there", .colour = Colour::purple, .mark = Mark::points, .width = point_size};
  const bool is_left_out = !drawn.file.blank && !drawn.counts();
  Curve good{.label = is_left_out ? "left out" : "counts",
             .colour = is_left_out ? Colour::grey : Colour::black,
             .mark = Mark::points,
             .width = point_size};
  for (std::size_t i = 0; i < whole.force.size(); ++i) {
    const bool is_idle = !counted.counts.empty() && counted.counts[i] == 0;
    const bool is_flagged =
        !whole.cycle.empty() && std::ranges::find(flagged, whole.cycle[i]) != flagged.end();
    Curve& curve = is_idle                             ? idle
                   : is_flagged && !plan.all_cycles    ? bad
                   : covered.empty() || covered[i] > 0 ? good
                                                       : beyond;
    curve.x.push_back(unit.factor * whole.penetration[i]);
    curve.y.push_back(whole.force[i]);
  }
  const char* const standing = drawn.file.blank ? " (blank)" : is_left_out ? " (left out)" : "";
  Chart chart{.title = drawn.name + standing,
              .x_label = fmt::format("penetration [{}]", unit.unit),
              .y_label = fmt::format("force [{}]", recording.axes[axis].force_unit)};
  for (Curve* curve : {&idle, &bad, &beyond, &good})
    if (!curve->x.empty()) chart.curves.push_back(thinned(std::move(*curve), most_points));
  chart.x_range = with_margins(chart.curves);
  chart.legend_below = true;
  chart.width_px = 420;
  chart.height_px = 300;
  return chart;
}

Chart quantity_chart(const StudyResults& results, const std::string& quantity) {
  Curve values{.label = "recordings", .colour = Colour::blue, .mark = Mark::circles, .width = value_size};
  Curve means{.label = "mean", .colour = Colour::vermillion, .mark = Mark::points, .width = value_size};
  Curve intervals{.label = "95 % of the mean", .colour = Colour::vermillion};
  Chart chart{.title = quantity, .legend_below = true};
  double at = 0.0;
  for (const StudiedGroup& group : results.groups) {
    const auto found = std::ranges::find(group.quantities, quantity, &StudiedQuantity::name);
    if (found == group.quantities.end()) continue;
    at += 1.0;
    chart.x_ticks.push_back({.at = at, .name = group.name()});
    chart.y_label = fmt::format("{} [{}]", quantity, found->unit);
    const auto drawn = [&](double value) { return found->is_logarithm ? std::exp(value) : value; };
    for (const population::Estimate& one : found->values) {
      values.x.push_back(at - 0.15);
      values.y.push_back(drawn(one.value));
    }
    if (!found->estimate.mean) continue;
    means.x.push_back(at + 0.15);
    means.y.push_back(drawn(*found->estimate.mean));
    if (!found->estimate.interval) continue;
    for (const double end : {found->estimate.interval->lower, found->estimate.interval->upper}) {
      intervals.x.push_back(at + 0.15);
      intervals.y.push_back(drawn(end));
    }
    intervals.x.push_back(line_break);
    intervals.y.push_back(line_break);
  }
  chart.x_range = {0.5, at + 0.5};
  for (Curve* curve : {&values, &intervals, &means})
    if (!curve->x.empty()) chart.curves.push_back(std::move(*curve));
  return chart;
}

}  // namespace kerf::bench
