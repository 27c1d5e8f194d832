#include "views/hysteresis_loops.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>

#include "inspect/flagged_cycles.h"
#include "laws/render.h"
#include "plot/plot.h"
#include "recordings/axis_values.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

using schema::Column;

constexpr std::uint64_t max_rows_segmented = 5'000'000;
constexpr std::size_t fewest_points = 600;
constexpr std::size_t points_of_all = 20'000;
constexpr std::size_t max_whole_points = 6000;

bool is_measured(const schema::RecordingFile& file) { return file.width(Column::force_measured) > 0; }

bool has_force(const schema::RecordingFile& file) { return file.width(force_column(file)) > 0; }

/// On which side the tissue lies; a scene that cannot be read does not say.
models::Contact contact_along(const schema::RecordingFile& file, std::size_t axis,
                              const std::optional<schema::Cycles>& cycles) {
  schema::Recording known;
  known.header.scene_toml = file.about().header.scene_toml;
  known.axes = file.about().axes;
  known.cycles = cycles;
  try {
    return contact_of(known, axis);
  } catch (const std::invalid_argument&) {
    known.header.scene_toml.clear();
    return contact_of(known, axis);
  }
}

void add_phases(const schema::Cycles& found, std::uint64_t rows, AxisCycles& cycles) {
  std::map<std::uint32_t, AxisCycles::Rows> by_number;
  for (const schema::PhaseSpan& phase : found.phases) {
    if (phase.begin >= phase.end || phase.end > rows) continue;  // of a file that does not hold together
    const auto [entry, is_new] = by_number.try_emplace(
        phase.cycle, AxisCycles::Rows{.cycle = phase.cycle, .begin = phase.begin, .end = phase.end});
    entry->second.begin = std::min(entry->second.begin, phase.begin);
    entry->second.end = std::max(entry->second.end, phase.end);
  }
  for (const auto& [number, span] : by_number) cycles.cycles.push_back(span);
}

void add_averages(const schema::RecordedRows& rows, const schema::Cycles& found, bool is_measured,
                  AxisCycles& cycles) {
  const schema::Axis& axis = rows.about().axes.at(found.axis);
  CycleMeans means =
      means_of_good_cycles(rows, found, fitting::jnd_of(axis.force_unit, axis.lever).threshold);
  cycles.grid = found.grid;
  cycles.closing = std::move(means.closing);
  cycles.opening = std::move(means.opening);
  cycles.averaged = means.cycles;
  for (auto* branch : {&cycles.closing, &cycles.opening}) {
    for (double& force : *branch) force = resisting(force, is_measured, cycles.contact);
  }
}

ForceLoop loop_of(const schema::RecordingFile& file, std::size_t axis, const AxisCycles::Rows& rows,
                  const models::Contact& contact, std::size_t most) {
  const BlockedValues position = axis_values(file, Column::position, axis);
  const BlockedValues force = axis_values(file, force_column(file), axis);
  const std::array<ValueOfRow, 2> columns{[&](std::size_t at) { return position[rows.begin + at]; },
                                          [&](std::size_t at) { return force[rows.begin + at]; }};
  ForceLoop loop{.cycle = rows.cycle, .rows = rows.end - rows.begin, .position = {}, .force = {}};
  for (const std::size_t at : decimated_rows(rows.end - rows.begin, columns, most)) {
    loop.position.push_back(columns[0](at));
    loop.force.push_back(resisting(columns[1](at), is_measured(file), contact));
  }
  return loop;
}

}  // namespace

AxisCycles axis_cycles(const schema::RecordingFile& file, std::size_t axis) {
  const schema::Recording& about = file.about();
  if (axis >= about.axes.size()) {
    throw std::invalid_argument(
        fmt::format("the recording has {} axes, there is no axis {}", about.axes.size(), axis));
  }
  AxisCycles cycles;
  std::optional<schema::Cycles> found = about.cycles;
  if (!has_force(file)) {
    cycles.why_none = "the recording holds no force";
    return cycles;
  }
  if (!found && file.rows() > max_rows_segmented) {
    cycles.why_none =
        fmt::format("{} rows are too many to look for cycles here; 'kerf segment' finds them", file.rows());
    return cycles;
  }
  if (!found) {
    try {
      found = find_cycles(file, {.axis = axis});
      cycles.segmented_here = true;
    } catch (const std::invalid_argument& error) {
      cycles.why_none = error.what();
      cycles.contact = contact_along(file, axis, found);
      return cycles;
    }
  }
  cycles.contact = contact_along(file, axis, found);
  add_phases(*found, file.rows(), cycles);
  if (cycles.cycles.empty()) cycles.why_none = "its cycles hold no rows";
  if (found->axis == axis) add_averages(file, *found, is_measured(file), cycles);
  return cycles;
}

std::vector<ForceLoop> force_loops(const schema::RecordingFile& file, std::size_t axis,
                                   const AxisCycles& cycles, std::size_t first, std::size_t count) {
  std::vector<ForceLoop> loops;
  if (first == 0 || first > cycles.cycles.size()) return loops;
  const auto from_first = std::span(cycles.cycles).subspan(first - 1);
  const auto shown = from_first.first(std::min(count, from_first.size()));
  if (shown.empty()) return loops;
  const std::size_t most = std::max(fewest_points, points_of_all / shown.size());
  for (const AxisCycles::Rows& rows : shown) loops.push_back(loop_of(file, axis, rows, cycles.contact, most));
  return loops;
}

ForceLoop whole_loop(const schema::RecordingFile& file, std::size_t axis, const AxisCycles& cycles) {
  if (!has_force(file) || file.rows() == 0 || file.rows() > max_rows_segmented) return {};
  return loop_of(file, axis, {.cycle = 0, .begin = 0, .end = file.rows()}, cycles.contact, max_whole_points);
}

}  // namespace kerf::bench
