#include "laws/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/models/branch.h>

#include "laws/law_toml.h"
#include "loop/command.h"
#include "signal/row_noise.h"

namespace kerf::bench {
namespace {

/// Of the row that is least engaged, but for such as jump there and back: they are of the encoder.
double least_engaged(const schema::Recording& recording, std::size_t axis) {
  std::vector<double> position;
  for (std::size_t row = 0; row < recording.rows(); ++row)
    position.push_back(recording.position[row * recording.dimensions() + axis]);
  std::vector<std::size_t> jumps;
  each_jump_and_back(position, [&](std::size_t row, double) { jumps.push_back(row); });
  for (const std::size_t row : jumps) position[row] = std::numeric_limits<double>::quiet_NaN();
  double smallest = std::numeric_limits<double>::infinity();
  for (const double one : position) smallest = std::fmin(smallest, one);
  return std::isfinite(smallest) ? smallest : 0.0;
}

}  // namespace

models::Contact contact_of(const schema::Recording& recording, std::size_t axis) {
  if (!recording.header.scene_toml.empty()) {
    const toml::table scene = parse_toml(recording.header.scene_toml, "the recording's scene");
    if (const toml::table* tissue = scene["tissue"].as_table()) {
      const LawFile law = law_from_table(*tissue, "the recording's scene", {"until"});
      if (law.axis == recording.axes.at(axis).name) return law.contact;
    }
  }
  const schema::Axis& about = recording.axes.at(axis);
  if (std::isfinite(about.contact_position) && std::isfinite(about.contact_direction)) {
    return {.position = about.contact_position, .direction = about.contact_direction};
  }
  if (recording.cycles && recording.cycles->axis == axis) {
    return {.position = recording.cycles->contact_position, .direction = recording.cycles->closing_direction};
  }
  return {.position = least_engaged(recording, axis), .direction = 1.0};
}

models::Law without_rendering_aids(const models::Law& law) {
  models::Options options = law.options();
  for (const models::OptionInfo& aid : models::BranchSelector::options()) options.erase(aid.name);
  return models::Law::make(law.model(), law.values(), options);
}

SampledMotion ticks_at(double rate_hz, std::size_t ticks) {
  SampledMotion motion;
  for (std::size_t tick = 0; tick < ticks; ++tick)
    motion.time_s.push_back(static_cast<double>(tick) / rate_hz);
  motion.period_s.assign(ticks, 1.0 / rate_hz);
  motion.sample.resize(ticks);
  return motion;
}

std::vector<double> periods_of(std::span<const double> time_s) {
  std::vector<double> periods(time_s.size(), 1e-3);
  for (std::size_t i = 1; i < time_s.size(); ++i) periods[i] = time_s[i] - time_s[i - 1];
  if (periods.size() > 1) periods[0] = periods[1];
  return periods;
}

double deepest(const SampledMotion& motion, std::size_t axis, const models::Contact& contact) {
  double depth = 0.0;
  for (const auto& [position, velocity] : motion.sample)
    depth = std::max(depth, contact.motion(position[axis], velocity[axis]).penetration);
  return depth;
}

std::vector<double> render(const models::Law& law, const AxisSeries& series) {
  std::vector<models::Motion> motion;
  motion.reserve(series.time_s.size());
  for (std::size_t i = 0; i < series.time_s.size(); ++i)
    motion.push_back({.penetration = series.penetration[i], .velocity = series.velocity[i]});
  return law.along(motion, periods_of(series.time_s));
}

RenderedMotion render(const LawFile& law, const std::vector<std::size_t>& axes, const SampledMotion& motion) {
  LawRendering rendering(law.law, law.contact, axes);
  RenderedMotion rendered;
  rendered.force.reserve(motion.ticks());
  for (std::size_t tick = 0; tick < motion.ticks(); ++tick) {
    const Command command = rendering(motion.sample[tick], motion.period_s[tick]);
    rendered.force.push_back(command.force);
    if ((command.flags & schema::flag_law_fault) == 0) continue;
    if (rendered.faults++ == 0) rendered.first_fault = tick;
  }
  return rendered;
}

}  // namespace kerf::bench
