#include "scene/read_trajectory.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <kerf/mechanisms/angle.h>

#include "laws/placement.h"
#include "scene/read_motion.h"

namespace kerf::bench {
namespace {

constexpr double cycles_at_most = 100.0;
constexpr std::size_t keyframes_at_most = 1000;

using drivers::PoseKeyframe;

/// A trajectory for one kind of device alone.
void expect_device(const Place& place, const toml::node& node, const drivers::DeviceInfo& device,
                   std::string_view kind, std::string_view model) {
  if (device.model == model) return;
  place.refuse(node, "a trajectory of the kind \"{}\" is for {}, and the scene's device is {}", kind, model,
               device.model);
}

drivers::HandOptions read_strokes(const Place& place, const toml::table& table,
                                  const drivers::DeviceInfo& device) {
  place.allow_only(table, {"kind", "seconds", "open", "close", "stroke", "pause", "variation"},
                   "a [trajectory] of strokes");
  const drivers::AxisInfo& theta = device.axes.front();
  drivers::HandOptions strokes;
  const auto angle = [&](std::string_view key, double standard, double lower, double upper) {
    return read_number(place, table,
                       {.key = key, .unit = "rad", .standard = standard, .lower = lower, .upper = upper});
  };
  strokes.open_rad = angle("open", strokes.open_rad, degree, theta.upper);
  strokes.close_rad = angle("close", strokes.close_rad, theta.lower, 59.0 * degree);
  strokes.stroke_s = read_seconds(place, table, "stroke", strokes.stroke_s, 0.05, 100.0);
  strokes.pause_s = read_seconds(place, table, "pause", strokes.pause_s, 0.0, 100.0);
  if (const toml::node* node = table.get("variation")) {
    strokes.variation = place.number(*node, "'variation'");
    if (!(strokes.variation >= 0.0 && strokes.variation <= 0.3))
      place.refuse(*node, "'variation' is {}, expected a number from 0 to 0.3", strokes.variation);
  }
  if (strokes.close_rad >= strokes.open_rad) {
    const toml::node* node = table.get("close");
    place.refuse(node != nullptr ? *node : table,
                 "'close' is {:.4g} deg and 'open' {:.4g} deg; 'close' must be the smaller angle",
                 strokes.close_rad / degree, strokes.open_rad / degree);
  }
  return strokes;
}

/// In and out along one axis, at rest at both ends; the other axes stay at zero.
struct Indentation {
  std::size_t axis = 0;
  StrokesToAndFro strokes{.stroke_s = 0.8, .pause_s = 0.5};
  double hold_s = 1.0;
  int cycles = 1;

  [[nodiscard]] drivers::PosePath::Options path() const {
    drivers::PosePath::Options path;
    double time_s = 0.0;
    const auto add = [&](double position, double lasting_s) {
      // Without the digits that sums leave behind; what takes no time needs no keyframe.
      time_s = std::round(1e9 * (time_s + lasting_s)) / 1e9;
      if (!path.keyframes.empty() && !(time_s > path.keyframes.back().at_s)) return;
      PoseKeyframe keyframe{.at_s = time_s, .position = {}};
      keyframe.position[axis] = position;
      path.keyframes.push_back(keyframe);
    };
    add(strokes.from, 0.0);
    for (int cycle = 0; cycle < cycles; ++cycle) {
      add(strokes.from, strokes.pause_s);
      add(strokes.to, strokes.stroke_s);
      add(strokes.to, hold_s);
      add(strokes.from, strokes.stroke_s);
    }
    return path;
  }
};

int read_cycles(const Place& place, const toml::table& table) {
  const toml::node* node = table.get("cycles");
  if (node == nullptr) return Indentation{}.cycles;
  const double cycles = place.number(*node, "'cycles'");
  if (!(cycles >= 1.0 && cycles <= cycles_at_most && cycles == std::floor(cycles)))
    place.refuse(*node, "'cycles' is {}, expected a whole number from 1 to {}", cycles, cycles_at_most);
  return static_cast<int>(cycles);
}

drivers::PosePath::Options read_indentation(const Place& place, const toml::table& table,
                                            const drivers::DeviceInfo& device) {
  place.allow_only(table, {"kind", "seconds", "axis", "from", "to", "stroke", "hold", "pause", "cycles"},
                   "a [trajectory] of the kind \"indent\"");
  const std::string name = place.text(table, "axis", "z");
  const auto axis = std::ranges::find(device.axes, name, &drivers::AxisInfo::name);
  if (axis == device.axes.end()) {
    place.refuse(*table.get("axis"), "'axis' is \"{}\", and the axes of {} are {}", name, device.model,
                 names_in(device.axes));
  }
  const Indentation standard;
  return Indentation{.axis = static_cast<std::size_t>(axis - device.axes.begin()),
                     .strokes = read_strokes(place, table,
                                             {.unit = axis->position_unit,
                                              .standard = standard.strokes,
                                              .lower = axis->lower,
                                              .upper = axis->upper,
                                              .shortest_s = 0.05,
                                              .longest_s = 100.0,
                                              .longest_pause_s = 1000.0}),
                     .hold_s = read_seconds(place, table, "hold", standard.hold_s, 0.0, 1000.0),
                     .cycles = read_cycles(place, table)}
      .path();
}

/// One keyframe; an axis that it does not name stays where it was.
PoseKeyframe read_keyframe(const Place& place, const toml::table& table, const drivers::DeviceInfo& device,
                           PoseKeyframe keyframe) {
  place.allow_only(table, {"at", "position"}, "[[trajectory.keyframe]]");
  keyframe.at_s = read_number(
      place, table, {.key = "at", .unit = "s", .lower = 0.0, .upper = longest_motion_s, .required = true});
  if (table.get("position") == nullptr) return keyframe;
  const toml::table& position = place.table(table, "position");
  for (const auto& [key, node] : position) {
    const auto axis = std::ranges::find(device.axes, key.str(), &drivers::AxisInfo::name);
    if (axis == device.axes.end()) {
      place.refuse(node, "unknown axis '{}' in a keyframe; those of {} are {}", key.str(), device.model,
                   names_in(device.axes));
    }
    keyframe.position[static_cast<std::size_t>(axis - device.axes.begin())] = read_number(
        place, position,
        {.key = key.str(), .unit = axis->position_unit, .lower = axis->lower, .upper = axis->upper});
  }
  return keyframe;
}

drivers::PosePath::Options read_keyframes(const Place& place, const toml::table& table,
                                          const drivers::DeviceInfo& device) {
  place.allow_only(table, {"kind", "seconds", "repeat", "keyframe"}, "a [trajectory] of keyframes");
  const toml::array* all = table.get_as<toml::array>("keyframe");
  if (all == nullptr || all->empty() || !all->is_homogeneous<toml::table>()) {
    const toml::node* node = table.get("keyframe");
    place.refuse(node != nullptr ? *node : table,
                 "a trajectory of keyframes needs one [[trajectory.keyframe]] or more");
  }
  if (all->size() > keyframes_at_most) {
    place.refuse((*all)[keyframes_at_most], "expected at most {} keyframes, found {}", keyframes_at_most,
                 all->size());
  }
  drivers::PosePath::Options path{.keyframes = {}, .repeat = place.flag(table, "repeat", false)};
  PoseKeyframe keyframe{};
  for (const toml::node& node : *all) {
    const double before_s = keyframe.at_s;
    keyframe = read_keyframe(place, *node.as_table(), device, keyframe);
    const toml::node& at = *node.as_table()->get("at");
    if (path.keyframes.empty() && keyframe.at_s != 0.0)
      place.refuse(at, "the first keyframe is at {:g} s, expected 0 s", keyframe.at_s);
    if (!path.keyframes.empty() && keyframe.at_s <= before_s) {
      place.refuse(at,
                   "a keyframe at {:g} s comes after one at {:g} s; each must be later than the one before",
                   keyframe.at_s, before_s);
    }
    path.keyframes.push_back(keyframe);
  }
  if (path.repeat && path.keyframes.back().position != path.keyframes.front().position) {
    place.refuse(*table.get("repeat"), "with 'repeat' the last keyframe must be the pose of the first");
  }
  return path;
}

}  // namespace

double read_number(const Place& place, const toml::table& table, const SceneNumber& about) {
  const toml::node* node = table.get(about.key);
  if (node == nullptr) {
    if (about.required) {
      place.refuse(table, "'{}' is missing; expected {} = {{ value = ..., unit = \"{}\" }}", about.key,
                   about.key, about.unit);
    }
    return about.standard;
  }
  const auto values = place.measured(*node, std::string(about.key), std::string(about.unit)).values;
  if (values.size() != 1) place.refuse(*node, "'{}' must be one number", about.key);
  const double value = values[0];
  // 60 deg is within 60 deg, whatever its last digit becomes in rad.
  const double slack = 1e-12 * std::abs(value);
  if (std::isfinite(value) && value >= about.lower - slack && value <= about.upper + slack)
    return std::clamp(value, about.lower, about.upper);
  if (std::isinf(about.upper)) {
    place.refuse(*node, "'{}' is {:.6g} {}, expected at least {:.6g} {}", about.key, value, about.unit,
                 about.lower, about.unit);
  }
  place.refuse(*node, "'{}' is {:.6g} {}, expected a number from {:.6g} to {:.6g} {}", about.key, value,
               about.unit, about.lower, about.upper, about.unit);
}

double read_seconds(const Place& place, const toml::table& table, std::string_view key, double standard,
                    double lower, double upper) {
  return read_number(place, table,
                     {.key = key, .unit = "s", .standard = standard, .lower = lower, .upper = upper});
}

Trajectory read_trajectory(const Place& place, const toml::table& table, const drivers::DeviceInfo& device) {
  const std::string kind = place.text(table, "kind", "");
  const toml::node& at = table.get("kind") != nullptr ? *table.get("kind") : table;
  Trajectory trajectory;
  double standard_s = trajectory.seconds;
  if (kind == "strokes") {
    expect_device(place, at, device, kind, "sim:scissors");
    trajectory.script = read_strokes(place, table, device);
  } else if (kind == "indent" || kind == "keyframes") {
    expect_device(place, at, device, kind, "sim:pose6");
    auto path =
        kind == "indent" ? read_indentation(place, table, device) : read_keyframes(place, table, device);
    if (path.keyframes.size() > 1) standard_s = path.keyframes.back().at_s;
    trajectory.script = std::move(path);
  } else {
    place.refuse(at, "'kind' is \"{}\", expected \"strokes\", \"indent\" or \"keyframes\"", kind);
  }
  trajectory.seconds = read_seconds(place, table, "seconds", standard_s, 0.01);
  return trajectory;
}

}  // namespace kerf::bench
