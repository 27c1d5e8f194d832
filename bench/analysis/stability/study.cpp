#include "stability/study.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "laws/placement.h"
#include "stability/device/in_hand.h"

namespace kerf::bench {
namespace {

SampledDevice device_of(const AxisRequest& given, const drivers::DeviceInfo& info, std::size_t axis) {
  SampledDevice device;
  const drivers::AxisInfo& about = info.axes[axis];
  if (about.mechanics) {
    device = sampled_device(info, axis, given.rate_hz);
  } else if (!given.mass_kg || !given.viscous_n_s_per_m || !given.coulomb_n) {
    throw std::invalid_argument(
        fmt::format("{}: mass and friction of axis '{}' are not known; give --mass, --viscous and --coulomb",
                    info.uri, about.name));
  } else {
    device.encoder_step_m = about.resolution * about.lever;
  }
  device.period_s = 1.0 / given.rate_hz;
  device.mass_kg = given.mass_kg.value_or(device.mass_kg);
  device.viscous_n_s_per_m = given.viscous_n_s_per_m.value_or(device.viscous_n_s_per_m);
  device.coulomb_n = given.coulomb_n.value_or(device.coulomb_n);
  device.encoder_step_m = given.encoder_step_m.value_or(device.encoder_step_m);
  device.velocity_corner_rad_s = given.velocity_corner_rad_s.value_or(device.velocity_corner_rad_s);
  device.delay_s = given.delay_s;
  device.hand = grip_named(given.grip);
  device.hand.mass_kg = given.hand_mass_kg.value_or(device.hand.mass_kg);
  device.hand.damping_n_s_per_m = given.hand_damping_n_s_per_m.value_or(device.hand.damping_n_s_per_m);
  device.hand.stiffness_n_per_m = given.hand_stiffness_n_per_m.value_or(device.hand.stiffness_n_per_m);
  check(device);
  return device;
}

std::size_t axis_of(const AxisRequest& given, const drivers::DeviceInfo& info) {
  if (given.axis.empty()) return 0;
  for (std::size_t at = 0; at < info.axes.size(); ++at) {
    if (info.axes[at].name == given.axis) return at;
  }
  throw std::invalid_argument(
      fmt::format("{} has no axis '{}'; it has {}", info.uri, given.axis, names_in(info.axes)));
}

Range range_of(const std::vector<double>& given, const char* option, Range standard, bool from_zero) {
  if (given.empty()) return standard;
  if (!(given[0] < given[1]) || !(from_zero ? given[0] >= 0.0 : given[0] > 0.0)) {
    throw std::invalid_argument(fmt::format("{} {} {}: expected a lower and a greater upper end, {}", option,
                                            given[0], given[1],
                                            from_zero ? "not negative" : "greater than 0"));
  }
  return {given[0], given[1]};
}

StudiedAxis studied(const StudyOptions& options, const drivers::DeviceInfo& info, std::size_t axis) {
  return {.device_uri = options.on.device_uri,
          .axis = info.axes[axis].name,
          .grip = options.on.grip,
          .way = options.on.way};
}

/// A law along its line, and the axis of the device whose mass and friction are taken.
std::pair<AxisLaw, std::size_t> placed_law(const LawFile& file, const std::string& name,
                                           const AxisRequest& on, const drivers::DeviceInfo& info) {
  if (file.law.is_spatial()) {
    const PlacedWay placed = place_way(on.way, file, info);
    const std::size_t axis = on.axis.empty() ? placed.device_axis : axis_of(on, info);
    return {{.law = file.law, .way = placed.way}, axis};
  }
  if (!on.way.along.empty() || !on.way.from.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: law '{}' has one axis, and --along and --from are of several", name, file.law.model()));
  }
  const std::size_t axis = on.axis.empty() ? axis_for(file, info) : axis_of(on, info);
  return {{.law = file.law, .lever = info.axes[axis].lever}, axis};
}

}  // namespace

Findings study_walls(const StudyOptions& options) {
  const drivers::DeviceInfo info = drivers::open_device(options.on.device_uri)->info();
  const std::size_t axis = axis_of(options.on, info);
  const SampledDevice device = device_of(options.on, info, axis);
  Grid2 grid = wall_grid(device, options.cells, options.cells);
  const Range stiffness =
      range_of(options.stiffness_n_per_m, "--stiffness", {grid.first.front(), grid.first.back()}, false);
  const Range damping =
      range_of(options.damping_n_s_per_m, "--damping", {grid.second.front(), grid.second.back()}, true);
  grid = {.first = logarithmic(stiffness.begin, stiffness.end, options.cells),
          .second = linear(damping.begin, damping.end, options.cells)};
  return findings_of(wall_map(device, options.trial, grid, options.map), studied(options, info, axis));
}

LawFindings study_law(const LawFile& file, const std::string& name, const StudyOptions& options) {
  constexpr double search = 10.0;  // times the depth that was given
  const drivers::DeviceInfo info = drivers::open_device(options.on.device_uri)->info();
  const auto [law, axis] = placed_law(file, name, options.on, info);
  const SampledDevice device = device_of(options.on, info, axis);
  const ToolRange& range = options.range;
  const std::size_t cells = std::min(options.cells, max_law_cells);
  const double rate_hz = options.on.rate_hz;
  const Grid2 grid{
      .first = linear(2.0 * range.depth_m / static_cast<double>(cells), 2.0 * range.depth_m, cells),
      .second = logarithmic(0.05 * rate_hz, 10.0 * rate_hz, cells)};
  LawStudy study{.model = std::string(file.law.model()),
                 .law = law,
                 .device = device,
                 .range = range,
                 .limits = limits_of(device, law, range, search * range.depth_m),
                 .map = law_map(device, law, range.speed_m_s, grid, options.map),
                 .passive = is_passive(device, law, range),
                 .worst = worst_stroke(device, law, range)};
  if (device.hand.stiffness_n_per_m > 0.0) study.pressed = press(device, law, {.depth_m = range.depth_m});
  return {.findings = findings_of(study, studied(options, info, axis)),
          .holds = study.passive && (!study.pressed || study.pressed->stable)};
}

}  // namespace kerf::bench
