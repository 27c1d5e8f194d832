#include "report/charts.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "recordings/axis_values.h"

namespace kerf::bench {
namespace {

using schema::Column;

std::string name_of(const schema::Axis& axis) { return axis.position_unit == "rad" ? "angle" : "position"; }

/// A few thousand points of so many, no spike lost.
Curve drawn(std::size_t points, const ValueOfRow& x, const ValueOfRow& y, std::size_t most = 4000) {
  Curve curve;
  for (const std::size_t i : decimated_rows(points, std::span(&y, 1), most)) {
    curve.x.push_back(x(i));
    curve.y.push_back(y(i));
  }
  return curve;
}

ValueOfRow times(double factor, const BlockedValues& values) {
  return [factor, &values](std::size_t row) { return factor * values[row]; };
}

/// The phases, but for those of a file that does not hold together.
std::vector<schema::PhaseSpan> phases_within(const schema::Cycles& cycles, std::uint64_t rows) {
  std::vector<schema::PhaseSpan> phases;
  std::ranges::copy_if(cycles.phases, std::back_inserter(phases), [rows](const schema::PhaseSpan& span) {
    return span.begin < span.end && span.end <= rows;
  });
  return phases;
}

constexpr std::size_t most_phases_drawn = 60;  ///< with more there are too few points for each
constexpr std::size_t points_of_phases = 8000;

/// The phases of one kind that are drawn: of very many some that are spread evenly.
struct DrawnPhases {
  std::vector<schema::PhaseSpan> spans;
  std::size_t all = 0;

  DrawnPhases(const std::vector<schema::PhaseSpan>& phases, schema::Phase phase)
      : all(static_cast<std::size_t>(std::ranges::count(phases, phase, &schema::PhaseSpan::phase))) {
    const std::size_t stride = (all + most_phases_drawn - 1) / most_phases_drawn;
    std::size_t number = 0;
    for (const schema::PhaseSpan& span : phases)
      if (span.phase == phase && number++ % stride == 0) spans.push_back(span);
  }
  /// "opening", and how many of them where it is not all.
  [[nodiscard]] std::string label(const char* name) const {
    return spans.size() == all ? name : fmt::format("{}, {} of {}", name, spans.size(), all);
  }
  /// Each for itself, so that no line leads from the end of one to the begin of the next.
  [[nodiscard]] Curve curve(double factor, const BlockedValues& position, const BlockedValues& force) const {
    Curve curve;
    for (const schema::PhaseSpan& span : spans) {
      const auto of_span = [&span](double times, const BlockedValues& values) -> ValueOfRow {
        return [times, &values, begin = span.begin](std::size_t row) { return times * values[begin + row]; };
      };
      const Curve one = drawn(span.end - span.begin, of_span(factor, position), of_span(1.0, force),
                              points_of_phases / spans.size());
      curve.x.insert(curve.x.end(), one.x.begin(), one.x.end());
      curve.y.insert(curve.y.end(), one.y.begin(), one.y.end());
      curve.x.push_back(line_break);
      curve.y.push_back(line_break);
    }
    return curve;
  }
};

/// Closing is blue and opening orange, in the studio's page as here (docs/glossary.md).
Colour colour_of(schema::Phase phase) {
  switch (phase) {
    case schema::Phase::opening:
      return Colour::orange;
    case schema::Phase::closing:
      return Colour::blue;
    case schema::Phase::open_to_close:
    case schema::Phase::close_to_open:
      return Colour::grey;
  }
  return Colour::grey;
}

std::vector<Band> phase_bands(const std::vector<schema::PhaseSpan>& phases, const BlockedValues& time_s) {
  std::vector<Band> bands;
  for (const schema::PhaseSpan& span : phases) {
    if (span.phase == schema::Phase::open_to_close) continue;
    bands.push_back({.begin = time_s[span.begin],
                     .end = time_s[std::min(span.end, time_s.size() - 1)],
                     .colour = colour_of(span.phase)});
  }
  return bands;
}

void align_times(Chart& chart, const BlockedValues& time_s) {
  if (time_s.size() > 1) align_times(chart, time_s[0], time_s[time_s.size() - 1]);
}

}  // namespace

void align_times(Chart& chart, double first_s, double last_s) {
  chart.left_margin = 10;
  chart.right_margin = 16;
  chart.x_range = {first_s, last_s};
}

Curve drawn_curve(const BlockedValues& x, double x_factor, const BlockedValues& y, double y_factor) {
  return drawn(y.size(), times(x_factor, x), times(y_factor, y));
}

DrawnUnit drawn_position(const schema::Axis& axis) {
  if (axis.position_unit == "rad") return {.factor = 180.0 / std::numbers::pi, .unit = "deg"};
  return {.factor = 1e3, .unit = "mm"};
}

Chart position_chart(const schema::Recording& about, const schema::RecordedRows& rows, std::size_t axis) {
  const DrawnUnit unit = drawn_position(about.axes[axis]);
  Chart chart{.title = "Position over time", .x_label = "time [s]"};
  chart.y_label = fmt::format("{} [{}]", name_of(about.axes[axis]), unit.unit);
  const BlockedValues time_s = axis_values(rows, Column::time);
  const BlockedValues position = axis_values(rows, Column::position, axis);
  align_times(chart, time_s);
  if (about.cycles && about.cycles->axis == axis) {
    chart.title = "Position over time: closing (blue), turning to open (grey), opening (orange)";
    chart.bands = phase_bands(phases_within(*about.cycles, rows.rows()), time_s);
    if (chart.bands.size() > static_cast<std::size_t>(chart.width_px)) {
      chart.title =
          fmt::format("Position over time: {} cycles, too many to tell apart", about.cycles->closing.size());
      chart.bands.clear();
    }
  }
  Curve& curve = chart.curves.emplace_back(drawn_curve(time_s, 1.0, position, unit.factor));
  curve.colour = Colour::black;
  curve.width = 1.2;
  return chart;
}

Chart force_chart(const schema::Recording& about, const schema::RecordedRows& rows, std::size_t axis) {
  Chart chart{.title = "Force over time", .x_label = "time [s]"};
  chart.y_label = fmt::format("force [{}]", about.axes[axis].force_unit);
  const BlockedValues time_s = axis_values(rows, Column::time);
  align_times(chart, time_s);
  const auto add = [&](Column column, const char* label, Colour colour) {
    if (rows.width(column) == 0) return;
    Curve& curve = chart.curves.emplace_back(drawn_curve(time_s, 1.0, axis_values(rows, column, axis), 1.0));
    curve.label = label;
    curve.colour = colour;
    curve.width = 1.0;
  };
  add(Column::force_measured, "measured", Colour::blue);
  add(Column::force_commanded, "commanded", Colour::orange);
  return chart;
}

Chart loop_chart(const schema::Recording& about, const schema::RecordedRows& rows, std::size_t axis) {
  const DrawnUnit unit = drawn_position(about.axes[axis]);
  Chart chart{.title = "Force against position", .height_px = 420};
  chart.x_label = fmt::format("{} [{}]", name_of(about.axes[axis]), unit.unit);
  chart.y_label = fmt::format("force [{}]", about.axes[axis].force_unit);
  const BlockedValues position = axis_values(rows, Column::position, axis);
  const BlockedValues force = axis_values(rows, force_column(rows), axis);
  if (!about.cycles || about.cycles->axis != axis) {
    Curve& curve = chart.curves.emplace_back(drawn_curve(position, unit.factor, force, 1.0));
    curve.label = "recorded";
    curve.colour = Colour::blue;
    curve.width = 1.0;
    return chart;
  }
  const schema::Cycles& cycles = *about.cycles;
  const auto phases = phases_within(cycles, rows.rows());
  const auto add_phase = [&](schema::Phase phase, const char* label, Colour colour) {
    const DrawnPhases of_phase(phases, phase);
    Curve& curve = chart.curves.emplace_back(of_phase.curve(unit.factor, position, force));
    curve.label = of_phase.label(label);
    curve.colour = colour;
    curve.width = 0.8;
  };
  add_phase(schema::Phase::opening, "opening", Colour::orange);
  add_phase(schema::Phase::closing, "closing", Colour::sky);
  std::vector<double> grid;
  for (const double at : cycles.grid) grid.push_back(unit.factor * at);
  chart.curves.push_back({.label = "opening, mean",
                          .x = grid,
                          .y = cycles.opening_mean,
                          .colour = Colour::vermillion,
                          .width = 3.0});
  chart.curves.push_back(
      {.label = "closing, mean", .x = grid, .y = cycles.closing_mean, .colour = Colour::blue, .width = 3.0});
  return chart;
}

}  // namespace kerf::bench
