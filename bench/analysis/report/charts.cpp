#include "report/charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> column(const std::vector<double>& values, const schema::Recording& recording,
                           std::size_t axis, double factor) {
  std::vector<double> one;
  for (std::size_t i = axis; i < values.size(); i += recording.dimensions())
    one.push_back(factor * values[i]);
  return one;
}

std::string name_of(const schema::Axis& axis) { return axis.position_unit == "rad" ? "angle" : "position"; }

const std::vector<double>& force_of(const schema::Recording& recording) {
  return recording.force_measured.empty() ? recording.force_commanded : recording.force_measured;
}

/// The rows of one kind of phase, with a break between cycles.
Curve phase_curve(const schema::Recording& recording, std::size_t axis, schema::Phase phase) {
  const std::size_t dimensions = recording.dimensions();
  const double factor = drawn_position(recording.axes[axis]).factor;
  Curve curve;
  for (const schema::PhaseSpan& span : recording.cycles->phases) {
    if (span.phase != phase) continue;
    for (std::size_t row = span.begin; row < span.end; ++row) {
      curve.x.push_back(factor * recording.position[row * dimensions + axis]);
      curve.y.push_back(force_of(recording)[row * dimensions + axis]);
    }
    curve.x.push_back(nothing);
    curve.y.push_back(nothing);
  }
  return curve;
}

Colour colour_of(schema::Phase phase) {
  switch (phase) {
    case schema::Phase::opening:
      return Colour::sky;
    case schema::Phase::open_to_close:
      return Colour::grey;
    case schema::Phase::closing:
      return Colour::vermillion;
    case schema::Phase::close_to_open:
      return Colour::yellow;
  }
  return Colour::grey;
}

}  // namespace

DrawnUnit drawn_position(const schema::Axis& axis) {
  if (axis.position_unit == "rad") return {.factor = 180.0 / std::numbers::pi, .unit = "deg"};
  return {.factor = 1e3, .unit = "mm"};
}

Chart position_chart(const schema::Recording& recording, std::size_t axis) {
  const DrawnUnit unit = drawn_position(recording.axes[axis]);
  Chart chart{.title = "Position over time", .x_label = "time [s]"};
  chart.y_label = fmt::format("{} [{}]", name_of(recording.axes[axis]), unit.unit);
  if (recording.cycles && recording.cycles->axis == axis) {
    chart.title = "Position over time: closing (red), turning to open (yellow), opening (blue)";
    for (const schema::PhaseSpan& span : recording.cycles->phases) {
      if (span.phase == schema::Phase::open_to_close) continue;
      chart.bands.push_back({.begin = recording.time[span.begin],
                             .end = recording.time[std::min<std::size_t>(span.end, recording.rows() - 1)],
                             .colour = colour_of(span.phase)});
    }
  }
  chart.curves.push_back(decimated({.x = recording.time,
                                    .y = column(recording.position, recording, axis, unit.factor),
                                    .colour = Colour::black,
                                    .width = 1.2}));
  return chart;
}

Chart force_chart(const schema::Recording& recording, std::size_t axis) {
  Chart chart{.title = "Force over time", .x_label = "time [s]"};
  chart.y_label = fmt::format("force [{}]", recording.axes[axis].force_unit);
  const auto add = [&](const std::vector<double>& force, const char* label, Colour colour) {
    if (force.empty()) return;
    chart.curves.push_back(decimated({.label = label,
                                      .x = recording.time,
                                      .y = column(force, recording, axis, 1.0),
                                      .colour = colour,
                                      .width = 1.0}));
  };
  add(recording.force_measured, "measured", Colour::blue);
  add(recording.force_commanded, "commanded", Colour::orange);
  return chart;
}

Chart loop_chart(const schema::Recording& recording, std::size_t axis) {
  const DrawnUnit unit = drawn_position(recording.axes[axis]);
  Chart chart{.title = "Force against position", .height_px = 420};
  chart.x_label = fmt::format("{} [{}]", name_of(recording.axes[axis]), unit.unit);
  chart.y_label = fmt::format("force [{}]", recording.axes[axis].force_unit);
  if (!recording.cycles || recording.cycles->axis != axis) {
    chart.curves.push_back(decimated({.label = "recorded",
                                      .x = column(recording.position, recording, axis, unit.factor),
                                      .y = column(force_of(recording), recording, axis, 1.0),
                                      .colour = Colour::blue,
                                      .width = 1.0}));
    return chart;
  }
  const schema::Cycles& cycles = *recording.cycles;
  const auto add_phase = [&](schema::Phase phase, const char* label, Colour colour) {
    Curve curve = phase_curve(recording, axis, phase);
    curve.label = label;
    curve.colour = colour;
    curve.width = 0.8;
    chart.curves.push_back(decimated(curve, 8000));
  };
  add_phase(schema::Phase::opening, "opening", Colour::sky);
  add_phase(schema::Phase::closing, "closing", Colour::orange);
  std::vector<double> grid;
  for (const double position : cycles.grid) grid.push_back(unit.factor * position);
  chart.curves.push_back(
      {.label = "opening, mean", .x = grid, .y = cycles.opening_mean, .colour = Colour::blue, .width = 3.0});
  chart.curves.push_back({.label = "closing, mean",
                          .x = grid,
                          .y = cycles.closing_mean,
                          .colour = Colour::vermillion,
                          .width = 3.0});
  return chart;
}

}  // namespace kerf::bench
