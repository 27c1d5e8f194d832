#include "scene/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/hand.h>
#include <kerf/schema/recording.h>

#include "laws/placement.h"
#include "recordings/axes.h"
#include "recordings/whole_recording.h"
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

SampledMotion scripted(const MotionSource& source) {
  const double ticks = std::round(source.seconds.value_or(standard_seconds) * source.rate_hz);
  SampledMotion path = ticks_at(source.rate_hz, static_cast<std::size_t>(ticks));
  for (const ScriptedAxis& motion : source.axes) {
    for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
      const Point point =
          std::visit([&](const auto& script) { return at(script, path.time_s[tick]); }, motion.script);
      path.sample[tick].position[motion.axis] = point.x;
      path.sample[tick].velocity[motion.axis] = point.v;
    }
  }
  return path;
}

SampledMotion along_scene(const MotionSource& source, const LawFile& law) {
  Scene scene = read_scene(source.scene);
  if (source.seconds) scene.trajectory.seconds = *source.seconds;
  const drivers::DeviceInfo device = drivers::open_device(device_of(scene))->info();
  const std::vector<std::size_t> axes = axes_for(law, device);
  SampledMotion path = tool_path(scene, source.rate_hz);
  for (models::SpatialMotion& sample : path.sample) {
    const models::SpatialMotion tool = std::exchange(sample, {});
    for (std::size_t i = 0; i < axes.size(); ++i) {
      sample.position[i] = tool.position[axes[i]];
      sample.velocity[i] = tool.velocity[axes[i]];
    }
  }
  return path;
}

/// The axis of a recording that a law's axis is on.
std::size_t column_for(const models::LawAxis& axis, bool by_name, const schema::Recording& recording) {
  const std::size_t column = find_axis(recording, by_name ? axis.name : "");
  if (recording.axes[column].position_unit != axis.position_unit) {
    throw std::invalid_argument(fmt::format("axis '{}' is in {}, and the law's in {}",
                                            recording.axes[column].name, recording.axes[column].position_unit,
                                            axis.position_unit));
  }
  return column;
}

SampledMotion recorded(const MotionSource& source, const std::vector<models::LawAxis>& axes, bool by_name) {
  const schema::Recording recording = read_whole_recording(source.recording);
  std::vector<std::size_t> columns;
  for (const models::LawAxis& axis : axes) columns.push_back(column_for(axis, by_name, recording));
  SampledMotion path;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const double time_s = recording.time[row] - recording.time.front();
    if (source.seconds && time_s >= *source.seconds - rounding_s) break;
    models::SpatialMotion sample;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      sample.position[i] = recording.position[row * recording.dimensions() + columns[i]];
      sample.velocity[i] = recording.velocity[row * recording.dimensions() + columns[i]];
      if (std::isfinite(sample.position[i]) && std::isfinite(sample.velocity[i])) continue;
      throw std::invalid_argument(
          fmt::format("row {} of axis '{}' is not finite; 'kerf prepare' mends gaps", row, axes[i].name));
    }
    path.time_s.push_back(recording.time[row]);
    path.sample.push_back(sample);
  }
  path.period_s = periods_of(path.time_s);
  return path;
}

}  // namespace

SampledMotion sampled(const MotionSource& source, const LawFile& law) {
  if (!source.recording.empty())
    return recorded(source, axes_of(law), law.law.is_spatial() || !law.axis.empty());
  return source.scene.empty() ? scripted(source) : along_scene(source, law);
}

SampledMotion sampled(const MotionSource& source, const std::vector<models::LawAxis>& axes) {
  if (!source.recording.empty()) return recorded(source, axes, true);
  if (source.scene.empty()) return scripted(source);
  throw std::invalid_argument(
      "the path of a scene is for laws; write it out by 'kerf regress trajectory' of a "
      "case with a law, and name it as 'trajectory'");
}

}  // namespace kerf::bench
