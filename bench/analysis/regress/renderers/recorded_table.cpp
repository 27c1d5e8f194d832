#include "regress/renderers/recorded_table.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "recordings/whole_recording.h"
#include "regress/renderers/force_columns.h"

namespace kerf::bench {
namespace {

/// Where a recording has an axis.
std::size_t column_of(const std::filesystem::path& file, const schema::Recording& recording,
                      const models::LawAxis& axis, std::string schema::Axis::*unit,
                      const std::string& expected) {
  const auto found = std::ranges::find(recording.axes, axis.name, &schema::Axis::name);
  if (found == recording.axes.end()) {
    std::string names;
    for (const schema::Axis& one : recording.axes) names += (names.empty() ? "" : ", ") + one.name;
    throw std::invalid_argument(
        fmt::format("{}: found the axes {}, expected also {}", file.string(), names, axis.name));
  }
  if ((*found).*unit != expected) {
    throw std::invalid_argument(
        fmt::format("{}: axis {} is in {}, expected {}", file.string(), axis.name, (*found).*unit, expected));
  }
  return static_cast<std::size_t>(found - recording.axes.begin());
}

/// A motion as a table of the columns that a renderer's has.
NumberTable trajectory_table(const std::filesystem::path& file, const std::vector<models::LawAxis>& axes) {
  const schema::Recording recording = read_whole_recording(file);
  NumberTable table;
  table.names = {"time[s]"};
  std::vector<std::size_t> columns;
  for (const models::LawAxis& axis : axes) {
    columns.push_back(column_of(file, recording, axis, &schema::Axis::position_unit, axis.position_unit));
    table.names.push_back(fmt::format("{}[{}]", axis.name, axis.position_unit));
    table.names.push_back(fmt::format("v{}[{}/s]", axis.name, axis.position_unit));
  }
  for (const schema::Channel& channel : recording.channels)
    table.names.push_back(fmt::format("{}[{}]", channel.name, channel.unit));
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    table.values.push_back(recording.time[row]);
    for (const std::size_t column : columns) {
      const std::size_t at = row * recording.dimensions() + column;
      table.values.push_back(recording.position[at]);
      table.values.push_back(recording.velocity[at]);
    }
    for (const schema::Channel& channel : recording.channels) table.values.push_back(channel.values[row]);
  }
  return table;
}

}  // namespace

bool is_recording(const std::filesystem::path& file) { return file.extension() == ".h5"; }

schema::Recording trajectory_recording(const SampledMotion& motion, const TrajectoryColumns& columns) {
  schema::Recording recording;
  for (const models::LawAxis& axis : columns.axes)
    recording.axes.push_back(
        {.name = axis.name, .position_unit = axis.position_unit, .force_unit = axis.force_unit});
  recording.time = motion.time_s;
  for (std::size_t tick = 0; tick < motion.ticks(); ++tick) {
    recording.tick.push_back(tick);
    for (std::size_t i = 0; i < columns.axes.size(); ++i) {
      recording.position.push_back(motion.sample[tick].position[i]);
      recording.velocity.push_back(motion.sample[tick].velocity[i]);
    }
  }
  recording.channels.push_back({.name = "period", .unit = "s", .values = motion.period_s});
  for (const char part : columns.quaternion) {
    std::vector<double> values;
    for (const models::SpatialMotion& sample : motion.sample) values.push_back(columns.turn(sample, part));
    recording.channels.push_back({.name = std::string("q") + part, .unit = "1", .values = std::move(values)});
  }
  return recording;
}

SampledMotion read_trajectory(const std::filesystem::path& file, const std::vector<models::LawAxis>& axes) {
  return is_recording(file) ? motion_of(trajectory_table(file, axes), axes, file)
                            : read_trajectory_csv(file, axes);
}

NumberTable read_force_recording(const std::filesystem::path& file,
                                 const std::vector<models::LawAxis>& axes) {
  const schema::Recording recording = read_whole_recording(file);
  const std::vector<double>& force =
      recording.force_commanded.empty() ? recording.force_measured : recording.force_commanded;
  if (force.empty())
    throw std::invalid_argument(fmt::format("{}: the recording has no forces", file.string()));
  NumberTable table;
  for (const auto& [name, value] : recording.header.scene_properties) {
    if (const auto* const text = std::get_if<std::string>(&value)) table.declared.emplace_back(name, *text);
  }
  table.names = {"time[s]"};
  std::vector<std::size_t> columns;
  for (const models::LawAxis& axis : axes) {
    columns.push_back(column_of(file, recording, axis, &schema::Axis::force_unit, axis.force_unit));
    table.names.push_back(force_column(axis));
  }
  if (!recording.compute_time.empty()) table.names.emplace_back("compute_time[s]");
  if (!recording.flags.empty()) table.names.emplace_back("fault");
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    table.values.push_back(recording.time[row]);
    for (const std::size_t column : columns)
      table.values.push_back(force[row * recording.dimensions() + column]);
    if (!recording.compute_time.empty())
      table.values.push_back(static_cast<double>(recording.compute_time[row]));
    if (!recording.flags.empty())
      table.values.push_back((recording.flags[row] & schema::flag_law_fault) != 0 ? 1.0 : 0.0);
  }
  return table;
}

}  // namespace kerf::bench
