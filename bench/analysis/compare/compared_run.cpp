#include "compare/compared_run.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>

#include <fmt/ranges.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/validate.h>

#include "files/named_file.h"
#include "formats/file_text.h"
#include "import/text/text_layout.h"
#include "import/text/text_table.h"
#include "laws/placement.h"
#include "recordings/whole_recording.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

bool is_hdf5(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".h5") || name.ends_with(".h5.partial");
}

std::vector<double> column_of(const std::vector<double>& rows, std::size_t axis, std::size_t axes) {
  std::vector<double> column;
  column.reserve(rows.size() / axes);
  for (std::size_t at = axis; at < rows.size(); at += axes) column.push_back(rows[at]);
  return column;
}

ComparedRun from_recording(const fs::path& file, const ComparedForce& which) {
  const schema::Recording recording = read_whole_recording(file);
  // Of a device that nobody commanded to push the sensor's is the force.
  const bool is_idle = !recording.force_measured.empty() &&
                       std::ranges::all_of(recording.force_commanded, [](double one) { return one == 0.0; });
  const bool commanded = !recording.force_commanded.empty() && !which.measured && !is_idle;
  const std::vector<double>& force = commanded ? recording.force_commanded : recording.force_measured;
  if (force.empty())
    throw std::invalid_argument(fmt::format("{}: it holds no {} force", file.string(),
                                            which.measured ? "measured" : "commanded or measured"));
  ComparedRun run{.name = file.string(), .series = {}, .notes = {}};
  run.series.time_s = recording.time;
  const std::size_t axes = recording.dimensions();
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const schema::Axis& about = recording.axes[axis];
    run.series.channels.push_back(
        {.name = about.name, .unit = about.force_unit, .value = column_of(force, axis, axes)});
    run.series.positions.push_back({.name = about.name,
                                    .unit = about.position_unit,
                                    .value = column_of(recording.position, axis, axes)});
    run.series.velocities.push_back({.name = about.name,
                                     .unit = about.position_unit + "/s",
                                     .value = column_of(recording.velocity, axis, axes)});
  }
  run.kind = RunKind::recording;
  run.sense = commanded ? ForceSense::commanded : ForceSense::measured;
  if (!commanded && !which.measured) run.notes.push_back(fmt::format("{}: the measured force", run.name));
  return run;
}

ComparedRun from_stored(const fs::path& file, const std::string& name) {
  std::vector<schema::StoredForces> all = schema::read_regression(file);
  const auto found = name.empty() && all.size() == 1
                         ? all.begin()
                         : std::ranges::find(all, name, &schema::StoredForces::name);
  if (found == all.end())
    throw std::invalid_argument(
        fmt::format("{}: there is no case '{}'; --case takes one of {}", file.string(), name, names_in(all)));
  ComparedRun run{.name = fmt::format("{}, {}", file.string(), found->name), .series = {}, .notes = {}};
  run.kind = RunKind::stored;
  const std::size_t channels = found->channels.size();
  for (std::size_t i = 0; i < channels; ++i)
    run.series.channels.push_back({.name = found->channels[i].name,
                                   .unit = found->channels[i].unit,
                                   .value = column_of(found->force, i, channels)});
  const schema::StoredTrajectory& path = found->trajectory;
  if (path.time_s.size() != run.series.rows()) {
    run.notes.push_back(fmt::format("{}: no times are stored: rows are taken to be 1 ms apart", run.name));
    return run;
  }
  run.series.time_s = path.time_s;
  for (std::size_t axis = 0; axis < path.axes.size(); ++axis)
    run.series.positions.push_back({.name = path.axes[axis].name,
                                    .unit = path.axes[axis].unit,
                                    .value = column_of(path.position, axis, path.axes.size())});
  return run;
}

/// Which of both a file is says its schema, asked for where it is no recording.
ComparedRun from_hdf5(const fs::path& file, const ComparedForce& force) {
  try {
    return from_recording(file, force);
  } catch (const schema::FormatError&) {
    if (schema::schema_of(file) != schema::regression_schema_name) throw;
    return from_stored(file, force.stored);
  }
}

/// What a column of a table is.
struct RunColumn {
  std::size_t index = 0;
  std::string name{};
  Unit unit{};
};

std::vector<RunColumn> run_columns(const TextLayout& layout, ComparedRun& run) {
  std::vector<RunColumn> columns;
  std::vector<std::string> left_out;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const TextColumn& column = layout.columns[i];
    try {
      if (!column.unit.empty()) {
        columns.push_back({.index = i, .name = column.name, .unit = parse_unit(column.unit)});
        if (std::ranges::count(std::array<std::string_view, 7>{"N", "N·m", "s", "m", "rad", "m/s", "rad/s"},
                               columns.back().unit.si) > 0)
          continue;
        columns.pop_back();
      }
    } catch (const std::invalid_argument&) {  // a unit that nobody knows: none of ours
    }
    left_out.push_back(column.heading.empty() ? fmt::format("column {}", i + 1) : column.heading);
  }
  if (!left_out.empty())
    run.notes.push_back(fmt::format("{}: left out, since neither force, position nor time by a unit: {}",
                                    run.name, fmt::join(left_out, ", ")));
  return columns;
}

ComparedRun from_table(const fs::path& file) {
  const FileText text(file, {.max_bytes = LargestInput::import});
  const TextLayout layout = find_layout(text.text(), text.name());
  ComparedRun run{.name = file.string(), .series = {}, .notes = text.notes()};
  const std::vector<RunColumn> columns = run_columns(layout, run);
  if (std::ranges::none_of(columns,
                           [](const RunColumn& one) { return one.unit.si == "N" || one.unit.si == "N·m"; }))
    throw std::invalid_argument(
        fmt::format("{}: no column is a force by its unit; expected a head such as 'time [s],x [N],rx [N·m]'",
                    text.name()));
  std::vector<std::size_t> indices;
  for (const RunColumn& one : columns) indices.push_back(one.index);
  std::atomic<std::size_t> done{0};
  TextTable table = parse_table(text.text(), layout, indices, done);
  text.require_whole();
  if (!table.bad_lines.empty())
    throw std::invalid_argument(fmt::format("{}:{}: not a row of {} numbers; of a run every row counts",
                                            text.name(), table.bad_lines.front(), layout.columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const RunColumn& one = columns[i];
    std::vector<double> values = std::move(table.columns[i]);
    if (layout.columns[one.index].stamps) {
      for (double& value : values) value *= 1e-9;
    } else if (one.unit.factor != 1.0) {
      for (double& value : values) value = one.unit.factor * value;
    }
    compare::Series& series = run.series;
    if (one.unit.si == "s") {
      if (series.time_s.empty()) series.time_s = std::move(values);
      continue;
    }
    auto& columns_to = one.unit.si.ends_with("/s")    ? series.velocities
                       : one.unit.si.starts_with("N") ? series.channels
                                                      : series.positions;
    columns_to.push_back({.name = one.name, .unit = one.unit.si, .value = std::move(values)});
  }
  if (run.series.time_s.empty())
    run.notes.push_back(fmt::format(
        "{}: no column is a time in seconds by its unit: rows are taken to be 1 ms apart", run.name));
  if (run.series.velocities.size() != run.series.positions.size()) run.series.velocities.clear();
  return run;
}

}  // namespace

ComparedRun read_run(const fs::path& file, const ComparedForce& force) {
  ComparedRun run = is_hdf5(file) ? from_hdf5(file, force) : from_table(file);
  if (!force.channel.empty()) {
    const std::string all = compare::names_of(run.series.channels);
    std::erase_if(run.series.channels,
                  [&](const compare::Channel& one) { return one.name != force.channel; });
    if (run.series.channels.empty())
      throw std::invalid_argument(
          fmt::format("{}: there is no force '{}'; it has {}", run.name, force.channel, all));
  }
  compare::require_sound(run.series, run.name);
  return run;
}

void require_kinds_of(const ComparedForce& force, const ComparedRun& expected, const ComparedRun& got) {
  const auto neither = [&](RunKind kind) { return expected.kind != kind && got.kind != kind; };
  if (force.measured && neither(RunKind::recording))
    throw std::invalid_argument("--measured says nothing of tables and stored forces; it is for recordings");
  if (!force.stored.empty() && neither(RunKind::stored))
    throw std::invalid_argument(
        "--case says nothing of tables and recordings; it is for a suite's stored forces");
}

void bring_to_one_sense(ComparedRun& expected, ComparedRun& got) {
  if (expected.sense == ForceSense::unknown || got.sense == ForceSense::unknown ||
      expected.sense == got.sense)
    return;
  ComparedRun& turned = expected.sense == ForceSense::commanded ? expected : got;
  for (compare::Channel& channel : turned.series.channels) {
    for (double& value : channel.value) value = -value;
  }
  turned.notes.push_back(fmt::format(
      "{}: the commanded force, which acts on the hand, beside one that was measured: its sign is turned",
      turned.name));
}

}  // namespace kerf::bench
