#include "regress/path.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/hand.h>
#include <kerf/schema/recording.h>

#include "laws/placement.h"
#include "recordings/axes.h"
#include "recordings/provenance.h"
#include "scene/scene.h"

namespace kerf::bench {
namespace {

constexpr double standard_seconds = 1.0;
constexpr double rounding_s = 1e-9;  ///< of time stamps

struct Point {
  double x = 0.0;
  double v = 0.0;
};

/// From a to b in `lasting_s`, along a stroke of minimum jerk.
Point stroke(double a, double b, double t, double lasting_s) {
  const drivers::MinimumJerk progress = drivers::MinimumJerk::at(t / lasting_s);
  return {a + (b - a) * progress.position, (b - a) * progress.speed / lasting_s};
}

Point at(const Rest& rest, double) { return {rest.at, 0.0}; }

Point at(const StrokesToAndFro& strokes, double time_s) {
  const double half = strokes.pause_s + strokes.stroke_s;
  const double number = std::floor(time_s / half);
  const bool back = std::fmod(number, 2.0) != 0.0;
  const double a = back ? strokes.to : strokes.from;
  const double b = back ? strokes.from : strokes.to;
  const double t = time_s - number * half - strokes.pause_s;
  return t <= 0.0 ? Point{a, 0.0} : stroke(a, b, std::min(t, strokes.stroke_s), strokes.stroke_s);
}

Point at(const Sine& sine, double time_s) {
  const double omega = 2.0 * std::numbers::pi * sine.frequency_hz;
  const double phase = omega * time_s + sine.phase_rad;
  return {sine.centre + sine.amplitude * std::sin(phase), sine.amplitude * omega * std::cos(phase)};
}

Point at(const RampAndHold& ramp, double time_s) {
  const double speed = (ramp.to - ramp.from) / ramp.ramp_s;
  const double in = time_s - ramp.start_s;
  if (in <= 0.0) return {ramp.from, 0.0};
  if (in < ramp.ramp_s) return {ramp.from + speed * in, speed};
  const double out = in - ramp.ramp_s - ramp.hold_s;
  if (out <= 0.0) return {ramp.to, 0.0};
  if (out < ramp.ramp_s) return {ramp.to - speed * out, -speed};
  return {ramp.from, 0.0};
}

/// Ticks at a rate; positions and velocities still to be filled in.
RegressionPath uniform(const RegressionCase& one, double seconds) {
  const auto ticks = static_cast<std::size_t>(std::round(seconds * one.rate_hz));
  RegressionPath path{.axes = axes_of(one.law), .time_s = {}, .period_s = {}, .position = {}, .velocity = {}};
  for (std::size_t tick = 0; tick < ticks; ++tick)
    path.time_s.push_back(static_cast<double>(tick) / one.rate_hz);
  path.period_s.assign(ticks, 1.0 / one.rate_hz);
  path.position.resize(ticks);
  path.velocity.resize(ticks);
  return path;
}

RegressionPath scripted(const RegressionCase& one) {
  RegressionPath path = uniform(one, one.seconds.value_or(standard_seconds));
  for (const ScriptedAxis& motion : one.motion) {
    for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
      const Point point =
          std::visit([&](const auto& script) { return at(script, path.time_s[tick]); }, motion.script);
      path.position[tick][motion.axis] = point.x;
      path.velocity[tick][motion.axis] = point.v;
    }
  }
  return path;
}

RegressionPath along_scene(const RegressionCase& one) {
  Scene scene = read_scene(one.scene);
  if (one.seconds) scene.trajectory.seconds = *one.seconds;
  const drivers::DeviceInfo device = drivers::open_device(device_of(scene))->info();
  const std::vector<std::size_t> axes = axes_for(one.law, device);
  const ToolPath tool = tool_path(scene, one.rate_hz);
  RegressionPath path = uniform(one, static_cast<double>(tool.position.size()) / one.rate_hz);
  for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      path.position[tick][i] = tool.position[tick][axes[i]];
      path.velocity[tick][i] = tool.velocity[tick][axes[i]];
    }
  }
  return path;
}

/// The axis of a recording that a law's axis is on.
std::size_t column_for(const models::LawAxis& axis, const LawFile& law, const schema::Recording& recording) {
  const std::size_t column = find_axis(recording, law.law.is_spatial() || !law.axis.empty() ? axis.name : "");
  if (recording.axes[column].position_unit != axis.position_unit) {
    throw std::invalid_argument(fmt::format("axis '{}' is in {}, and the law's in {}",
                                            recording.axes[column].name, recording.axes[column].position_unit,
                                            axis.position_unit));
  }
  return column;
}

RegressionPath recorded(const RegressionCase& one) {
  const schema::Recording recording = schema::read_recording(one.recording);
  RegressionPath path{.axes = axes_of(one.law), .time_s = {}, .period_s = {}, .position = {}, .velocity = {}};
  std::vector<std::size_t> columns;
  for (const models::LawAxis& axis : path.axes) columns.push_back(column_for(axis, one.law, recording));
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const double time_s = recording.time[row] - recording.time.front();
    if (one.seconds && time_s >= *one.seconds - rounding_s) break;
    models::AxisValues position{};
    models::AxisValues velocity{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      position[i] = recording.position[row * recording.dimensions() + columns[i]];
      velocity[i] = recording.velocity[row * recording.dimensions() + columns[i]];
      if (std::isfinite(position[i]) && std::isfinite(velocity[i])) continue;
      throw std::invalid_argument(fmt::format("row {} of axis '{}' is not finite; 'kerf prepare' mends gaps",
                                              row, path.axes[i].name));
    }
    path.time_s.push_back(recording.time[row]);
    path.position.push_back(position);
    path.velocity.push_back(velocity);
  }
  // The first row has no period before it; the next one's stands in, since a law only starts there.
  for (std::size_t i = 0; i < path.ticks(); ++i) {
    const std::size_t end = std::min(std::max<std::size_t>(i, 1), path.ticks() - 1);
    path.period_s.push_back(end > 0 ? path.time_s[end] - path.time_s[end - 1] : 1e-3);
  }
  return path;
}

void add_bytes(std::string& bytes, double value) {
  auto bits = std::bit_cast<std::uint64_t>(value);
  for (int i = 0; i < 8; ++i, bits >>= 8U) bytes += static_cast<char>(bits & 0xFFU);
}

}  // namespace

RegressionPath trajectory_of(const RegressionCase& one) {
  return !one.recording.empty() ? recorded(one) : !one.scene.empty() ? along_scene(one) : scripted(one);
}

RegressionPath path_of(const RegressionCase& one) {
  RegressionPath path;
  try {
    path = trajectory_of(one);
  } catch (const std::invalid_argument& error) {
    const std::string source = one.recording.empty() ? one.scene.string() : one.recording.string();
    const std::string what = error.what();
    throw std::invalid_argument(fmt::format(
        "case '{}': {}{}", one.name, source.empty() || what.starts_with(source) ? "" : source + ": ", what));
  }
  if (path.ticks() == 0)
    throw std::invalid_argument(fmt::format("case '{}': its trajectory has no tick", one.name));
  return path;
}

std::string checksum(const RegressionPath& path) {
  std::string bytes;
  for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
    add_bytes(bytes, path.period_s[tick]);
    for (std::size_t i = 0; i < path.axes.size(); ++i) {
      add_bytes(bytes, path.position[tick][i]);
      add_bytes(bytes, path.velocity[tick][i]);
    }
  }
  return sha256_of(std::string_view(bytes));
}

std::string checksum(const LawFile& law) {
  LawFile bare = law;
  bare.std_errors.clear();
  bare.fit = {};
  const std::string text = to_toml(bare);
  return sha256_of(std::string_view(text));
}

}  // namespace kerf::bench
