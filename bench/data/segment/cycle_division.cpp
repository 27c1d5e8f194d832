#include "segment/cycle_division.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

#include "recordings/row_span.h"
#include "segment/strokes.h"

namespace kerf::bench {
namespace {

using schema::Phase;
using schema::PhaseSpan;

RowSpan rows_of_cycle(const std::vector<PhaseSpan>& phases, std::uint32_t cycle, std::uint64_t rows) {
  RowSpan span{.begin = rows, .end = 0};
  for (const PhaseSpan& phase : phases) {
    if (phase.cycle != cycle) continue;
    span = {.begin = std::min<std::size_t>(span.begin, phase.begin),
            .end = std::max<std::size_t>(span.end, phase.end)};
  }
  if (span.begin >= span.end || span.end > rows)
    throw std::invalid_argument(fmt::format("there is no cycle {}", cycle));
  return span;
}

double height_of(const AxisMotion& motion, RowSpan rows) {
  double least = motion.position(rows.begin);
  double most = least;
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    least = std::min(least, motion.position(row));
    most = std::max(most, motion.position(row));
  }
  return most - least;
}

struct Closing {
  Turn open;
  Turn closed;
};

/// The largest rise of the position.
Closing largest_rise(const AxisMotion& motion, RowSpan rows) {
  const Turn first{.row = rows.begin, .position = motion.position(rows.begin), .closed = false};
  Turn lowest = first;
  Closing largest{.open = first, .closed = first};
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const double position = motion.position(row);
    if (position < lowest.position) lowest = {.row = row, .position = position, .closed = false};
    if (position - lowest.position <= largest.closed.position - largest.open.position) continue;
    largest = {.open = lowest, .closed = {.row = row, .position = position, .closed = true}};
  }
  return largest;
}

/// Appends the phases of a cycle that has these rows.
void add_cycle(std::vector<PhaseSpan>& phases, const AxisMotion& motion, std::uint32_t cycle, RowSpan rows,
               double least_height, double dwell) {
  const Closing rise = largest_rise(motion, rows);
  if (!(rise.closed.position - rise.open.position >= least_height))
    throw std::invalid_argument(
        fmt::format("cycle {}: the rows {} to {} hold no closing; expected a row between two closings", cycle,
                    rows.begin, rows.end));
  Turn last = rise.closed;
  for (std::size_t row = rise.closed.row; row < rows.end; ++row) {
    if (motion.position(row) < last.position)
      last = {.row = row, .position = motion.position(row), .closed = false};
  }
  const StrokeRows closing = stroke_between(motion, rise.open, rise.closed, dwell);
  const bool opens_again = rise.closed.position - last.position >= least_height;
  const std::uint64_t opening =
      opens_again ? stroke_between(motion, rise.closed, last, dwell).begin : rows.end;
  const auto add = [&](Phase phase, std::uint64_t begin, std::uint64_t end) {
    if (end > begin) phases.push_back({.cycle = cycle, .phase = phase, .begin = begin, .end = end});
  };
  add(Phase::open_to_close, rows.begin, closing.begin);
  add(Phase::closing, closing.begin, closing.end);
  add(Phase::close_to_open, closing.end, opening);
  add(Phase::opening, opening, rows.end);
}

}  // namespace

std::vector<PhaseSpan> split_cycle(const AxisMotion& motion, const std::vector<PhaseSpan>& phases,
                                   std::uint32_t cycle, std::uint64_t row, const DivisionOptions& options) {
  const RowSpan whole = rows_of_cycle(phases, cycle, motion.rows());
  if (row <= whole.begin || row >= whole.end)
    throw std::invalid_argument(
        fmt::format("cycle {} has the rows {} to {}; expected a row between them to "
                    "split it at, not {}",
                    cycle, whole.begin, whole.end, row));
  const double least = options.stroke * height_of(motion, whole);
  std::vector<PhaseSpan> divided;
  for (const PhaseSpan& phase : phases) {
    if (phase.cycle < cycle) divided.push_back(phase);
  }
  add_cycle(divided, motion, cycle, {.begin = whole.begin, .end = row}, least, options.dwell);
  add_cycle(divided, motion, cycle + 1, {.begin = row, .end = whole.end}, least, options.dwell);
  for (PhaseSpan phase : phases) {
    if (phase.cycle <= cycle) continue;
    ++phase.cycle;
    divided.push_back(phase);
  }
  return divided;
}

std::vector<PhaseSpan> merge_cycles(const AxisMotion& motion, const std::vector<PhaseSpan>& phases,
                                    std::uint32_t cycle, const DivisionOptions& options) {
  const RowSpan first = rows_of_cycle(phases, cycle, motion.rows());
  const RowSpan second = rows_of_cycle(phases, cycle + 1, motion.rows());
  const RowSpan whole{.begin = first.begin, .end = second.end};
  std::vector<PhaseSpan> merged;
  for (const PhaseSpan& phase : phases) {
    if (phase.cycle < cycle) merged.push_back(phase);
  }
  add_cycle(merged, motion, cycle, whole, options.stroke * height_of(motion, whole), options.dwell);
  for (PhaseSpan phase : phases) {
    if (phase.cycle <= cycle + 1) continue;
    --phase.cycle;
    merged.push_back(phase);
  }
  return merged;
}

}  // namespace kerf::bench
