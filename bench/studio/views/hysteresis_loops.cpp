#include "views/hysteresis_loops.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>

#include <fmt/core.h>

#include "laws/render.h"
#include "plot/plot.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

using schema::Column;

constexpr std::uint64_t max_rows_segmented = 5'000'000;
constexpr std::size_t max_points = 600;

bool is_measured(const schema::RecordingFile& file) { return file.width(Column::force_measured) > 0; }

Column force_of(const schema::RecordingFile& file) {
  return is_measured(file) ? Column::force_measured : Column::force_commanded;
}

bool has_force(const schema::RecordingFile& file) { return file.width(force_of(file)) > 0; }

/// One axis of a column; the others are passed over block by block.
std::vector<double> axis_of(const schema::RecordingFile& file, Column column, std::size_t axis,
                            std::uint64_t first, std::uint64_t end) {
  constexpr std::uint64_t rows_at_once = 8192;
  const std::size_t width = file.width(column);
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(end - first));
  std::vector<double> block;
  for (; first < end; first += rows_at_once) {
    const auto rows = std::min(rows_at_once, end - first);
    block.resize(static_cast<std::size_t>(rows) * width);
    file.read(column, first, rows, block);
    for (std::size_t at = axis; at < block.size(); at += width) values.push_back(block[at]);
  }
  return values;
}

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

void add_averages(const schema::Cycles& found, bool is_measured, AxisCycles& cycles) {
  cycles.grid = found.grid;
  cycles.closing = found.closing_mean;
  cycles.opening = found.opening_mean;
  for (auto* branch : {&cycles.closing, &cycles.opening}) {
    for (double& force : *branch) force = resisting(force, is_measured, cycles.contact);
  }
}

schema::Cycles cycles_found(const schema::RecordingFile& file, std::size_t axis) {
  schema::Recording alone;
  alone.axes = {file.about().axes[axis]};
  alone.time = axis_of(file, Column::time, 0, 0, file.rows());
  alone.position = axis_of(file, Column::position, axis, 0, file.rows());
  alone.force_measured = axis_of(file, force_of(file), axis, 0, file.rows());
  schema::Cycles found = find_cycles(alone, {});
  found.axis = axis;
  return found;
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
      found = cycles_found(file, axis);
      cycles.segmented_here = true;
    } catch (const std::invalid_argument& error) {
      cycles.why_none = error.what();
      return cycles;
    }
  }
  cycles.contact = contact_along(file, axis, found);
  add_phases(*found, file.rows(), cycles);
  if (cycles.cycles.empty()) cycles.why_none = "its cycles hold no rows";
  if (found->axis == axis) add_averages(*found, is_measured(file), cycles);
  return cycles;
}

std::vector<ForceLoop> force_loops(const schema::RecordingFile& file, std::size_t axis,
                                   const AxisCycles& cycles, std::size_t first, std::size_t count) {
  std::vector<ForceLoop> loops;
  if (first == 0 || first > cycles.cycles.size()) return loops;
  const auto shown = std::span(cycles.cycles).subspan(first - 1);
  for (std::size_t i = 0; i < std::min(count, shown.size()); ++i) {
    const auto position = axis_of(file, Column::position, axis, shown[i].begin, shown[i].end);
    const auto force = axis_of(file, force_of(file), axis, shown[i].begin, shown[i].end);
    ForceLoop loop{.cycle = shown[i].cycle, .position = {}, .force = {}};
    for (const std::size_t at : decimated_rows({position, force}, max_points)) {
      loop.position.push_back(position[at]);
      loop.force.push_back(resisting(force[at], is_measured(file), cycles.contact));
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace kerf::bench
