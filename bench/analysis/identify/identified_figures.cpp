#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "identify/identified_device.h"

namespace kerf::bench {
namespace {

using identification::Identified;

/// Of what was measured, to be seen over a line.
Curve device_points(const std::string& label) {
  return {
      .label = label, .x = {}, .y = {}, .colour = Colour::blue, .mark = Mark::points, .width = 3.0, .of = {}};
}
Curve model_line() {
  return {.label = "model", .x = {}, .y = {}, .colour = Colour::vermillion, .width = 2.0, .of = {}};
}

Curve of_response(const std::vector<identification::ResponseLine>& lines, bool phase, Curve curve) {
  double last = 0.0;
  for (const identification::ResponseLine& line : lines) {
    curve.x.push_back(line.frequency_hz);
    double value = std::abs(line.response);
    if (phase) {
      value = std::arg(line.response) * 180.0 / std::numbers::pi;
      while (value - last > 180.0) value -= 360.0;
      while (value - last < -180.0) value += 360.0;
      last = value;
    }
    curve.y.push_back(value);
  }
  return curve;
}

/// What is left of the command for friction, over the speed, in groups: u + o - m a - k x, with the
/// acceleration over 16 ticks and the command in the mean that belongs to it.
Curve felt_friction(const identification::Experiment& experiment, const Identified& found, double fastest) {
  constexpr std::size_t half = 8;
  constexpr std::size_t groups = 25;
  const identification::AxisModel& axis = found.time.model.axis;
  const auto& x = experiment.data.position_m;
  const double time_s = static_cast<double>(half) * experiment.data.period_s;
  const auto late = static_cast<std::size_t>(std::lround(axis.delay_s / experiment.data.period_s + 0.5));
  std::vector<double> sums(groups, 0.0);
  std::vector<double> counts(groups, 0.0);
  for (const identification::Stretch& stretch : experiment.stretches) {
    for (std::size_t n = stretch.begin + half + late; n + half < stretch.end(); ++n) {
      const double speed = (x[n + half] - x[n - half]) / (2.0 * time_s);
      const double acceleration = (x[n + half] - 2.0 * x[n] + x[n - half]) / (time_s * time_s);
      double force =
          found.offset_n[stretch.place].value - axis.stiffness_n_per_m * x[n] - axis.mass_kg * acceleration;
      for (std::size_t i = 0; i <= 2 * half; ++i) {
        const std::size_t from_middle = i > half ? i - half : half - i;
        const double weight = static_cast<double>(half - from_middle) / static_cast<double>(half * half);
        force += weight * experiment.data.commanded_n[n + i - half - late];
      }
      if (!std::isfinite(force) || std::abs(speed) >= fastest) continue;
      const auto group =
          static_cast<std::size_t>(0.5 * (speed / fastest + 1.0) * static_cast<double>(groups));
      sums[std::min(group, groups - 1)] += force;
      counts[std::min(group, groups - 1)] += 1.0;
    }
  }
  Curve curve = device_points("device");
  for (std::size_t group = 0; group < groups; ++group) {
    if (counts[group] < 20.0) continue;
    curve.x.push_back(fastest *
                      (2.0 * (static_cast<double>(group) + 0.5) / static_cast<double>(groups) - 1.0));
    curve.y.push_back(sums[group] / counts[group]);
  }
  return curve;
}

/// Whether there is something to draw: without one whole period there is no response, and of a single one no
/// coherence.
bool has_points(const Chart& chart) {
  return std::ranges::any_of(chart.curves, [&](const Curve& curve) {
    return std::ranges::any_of(curve.y,
                               [&](double y) { return std::isfinite(y) && (y > 0.0 || !chart.log_y); });
  });
}

/// Points of the device over a line of its model.
std::vector<Curve> both(Curve model, Curve device) { return {std::move(model), std::move(device)}; }

Chart friction_chart(const IdentifiedDevice& identified, const IdentifiedAxis& of) {
  // Friction as the model has it over the speeds of the motion, beside what the data say: the force that is
  // left for it, in groups of speed.
  const Identified& found = *of.found;
  const drivers::AxisInfo& about = identified.device.axes.at(of.axis);
  const identification::AxisModel& axis = found.time.model.axis;
  double fastest = 0.0;
  const auto& simulated = found.time.simulated_m;
  for (std::size_t n = 1; n < simulated.size(); ++n) {
    const double speed = (simulated[n] - simulated[n - 1]) / of.measured.experiment.data.period_s;
    if (std::isfinite(speed)) fastest = std::max(fastest, std::abs(speed));
  }
  Curve friction = model_line();
  for (const double share : {-1.0, -1e-6, 1e-6, 1.0}) {
    friction.x.push_back(share * fastest);
    friction.y.push_back(axis.viscous_n_s_per_m * share * fastest + std::copysign(axis.coulomb_n, share));
  }
  Chart chart{.title = fmt::format("Axis {}: friction", about.name),
              .x_label = about.force_unit == "N·m" ? "speed [rad/s]" : "speed [m/s]",
              .y_label = fmt::format("force [{}]", about.force_unit)};
  chart.curves = both(std::move(friction), felt_friction(of.measured.experiment, found, fastest));
  return chart;
}

}  // namespace

std::vector<Figure> axis_figures(const IdentifiedDevice& identified, const IdentifiedAxis& of) {
  const Identified& found = *of.found;
  const drivers::AxisInfo& about = identified.device.axes.at(of.axis);
  const std::string& name = about.name;
  const auto response = [&](bool phase) {
    return both(of_response(found.response_of_model, phase, model_line()),
                of_response(found.response, phase, device_points("device")));
  };
  Chart gain{.title = fmt::format("Axis {}: position over commanded force", name),
             .x_label = "frequency [Hz]",
             .y_label = about.force_unit == "N·m" ? "gain [rad/(N·m)]" : "gain [m/N]",
             .log_x = true,
             .log_y = true};
  gain.curves = response(false);
  Chart phase{.title = fmt::format("Axis {}: its phase", name),
              .x_label = "frequency [Hz]",
              .y_label = "phase [deg]",
              .log_x = true};
  phase.curves = response(true);
  Curve coherence = device_points("coherence");
  Curve lower{
      .label = "lower end, 95 %", .x = {}, .y = {}, .colour = Colour::black, .dashed = true, .of = {}};
  for (const identification::ResponseLine& line : found.response) {
    coherence.x.push_back(line.frequency_hz);
    coherence.y.push_back(line.coherence.value);
    lower.x.push_back(line.frequency_hz);
    lower.y.push_back(line.coherence.lower);
  }
  Chart coherent{.title = fmt::format("Axis {}: its coherence", name),
                 .x_label = "frequency [Hz]",
                 .y_label = "coherence",
                 .y_range = {.begin = 0.0, .end = 1.05},
                 .log_x = true};
  coherent.curves = both(std::move(lower), std::move(coherence));
  std::vector<Figure> figures;
  const auto add = [&](const char* what, Chart chart) {
    if (has_points(chart)) figures.push_back({.name = name + what, .chart = std::move(chart)});
  };
  add("-gain", std::move(gain));
  add("-phase", std::move(phase));
  add("-coherence", std::move(coherent));
  add("-friction", friction_chart(identified, of));
  if (!of.z_width) return figures;
  for (const Figure& figure : of.z_width->figures)
    figures.push_back({.name = fmt::format("{}-{}", name, figure.name), .chart = figure.chart});
  return figures;
}

}  // namespace kerf::bench
