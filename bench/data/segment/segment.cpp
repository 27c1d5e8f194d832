#include "segment/segment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "recordings/axis_values.h"
#include "recordings/provenance.h"
#include "segment/branches.h"
#include "segment/closing_direction.h"
#include "segment/strokes.h"
#include "signal/quantiles.h"
#include "signal/row_noise.h"
#include "signal/streamed_median.h"

namespace kerf::bench {
namespace {

constexpr double beyond_noise = 4.0;  // standard deviations
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Least and most position.
std::pair<double, double> range_of(const AxisMotion& motion) {
  double least = motion.position(0);
  double most = least;
  for (std::uint64_t row = 1; row < motion.rows(); ++row) {
    least = std::min(least, motion.position(row));
    most = std::max(most, motion.position(row));
  }
  return {least, most};
}

/// The beginning of a signal: its noise is that of the rest.
struct FirstRows {
  const BlockedValues& values;
  [[nodiscard]] std::size_t size() const { return std::min<std::size_t>(values.size(), 200'000); }
  [[nodiscard]] double operator[](std::size_t row) const { return values[row]; }
};

/// What the low-pass makes of the white noise of a position.
struct PositionNoise {
  double of_a_row = 0.0;    ///< standard deviation, 0 where there is none
  double passed = 1.0;      ///< share of its variance that is left
  std::uint64_t reach = 1;  ///< rows from a turn within which the low-pass moves it

  [[nodiscard]] double after() const { return of_a_row * std::sqrt(passed); }
};

PositionNoise noise_of(const AxisMotion& motion, const schema::RecordedRows& rows, std::size_t axis) {
  const BlockedValues position = axis_values(rows, schema::Column::position, axis);
  const BlockedValues time_s = axis_values(rows, schema::Column::time);
  const std::uint64_t last = motion.rows() - 1;
  const double seconds = time_s[last] - time_s[0];
  const auto each = [&](const auto& look) {
    each_second_difference(
        position, [](std::size_t) { return true; }, look);
  };
  const double median = StreamedMedian::of(each);
  PositionNoise noise;
  if (median > 0.0) noise.of_a_row = noise_of_second_differences(median);
  if (!(seconds > 0.0) || !(motion.corner_hz() > 0.0)) return noise;
  const double rate_hz = static_cast<double>(last) / seconds;
  noise.passed = std::min(1.0, 2.0 * motion.corner_hz() / rate_hz);
  noise.reach = 1 + static_cast<std::uint64_t>(0.5 * rate_hz / motion.corner_hz());
  return noise;
}

/// Where a turn from opening to closing stands: at the low-passed path's, but where it is a corner, which the
/// low-pass cuts off, at the least row beside it. A row is that where noise would not be as far beyond.
double open_end(const AxisMotion& motion, const Turn& turn, const PositionNoise& noise) {
  const std::uint64_t begin = turn.row - std::min(turn.row, noise.reach);
  const std::uint64_t end = std::min(motion.rows(), turn.row + noise.reach + 1);
  double least = turn.position;
  for (std::uint64_t row = begin; row < end; ++row) least = std::min(least, motion.recorded_position(row));
  return turn.position - least > beyond_noise * noise.of_a_row ? least : turn.position;
}

/// Turning points whose prominence is at least `height`, alternately closed and open.
std::vector<Turn> find_turns(const AxisMotion& motion, double height) {
  std::vector<Turn> turns;
  Turn highest{.row = 0, .position = motion.position(0), .closed = true};
  Turn lowest{.row = 0, .position = motion.position(0), .closed = false};
  int direction = 0;  // of the stroke under way, unknown at first
  for (std::uint64_t row = 0; row < motion.rows(); ++row) {
    const double position = motion.position(row);
    if (position > highest.position) highest = {.row = row, .position = position, .closed = true};
    if (position < lowest.position) lowest = {.row = row, .position = position, .closed = false};
    if (direction >= 0 && highest.position - position >= height) {
      turns.push_back(highest);
      direction = -1;
      lowest = {.row = row, .position = position, .closed = false};
    } else if (direction <= 0 && position - lowest.position >= height) {
      turns.push_back(lowest);
      direction = 1;
      highest = {.row = row, .position = position, .closed = true};
    }
  }
  if (direction != 0) turns.push_back(direction > 0 ? highest : lowest);
  return turns;
}

void check(const schema::RecordedRows& rows, const SegmentOptions& options) {
  const std::size_t axes = rows.about().dimensions();
  if (options.axis >= axes) {
    throw std::invalid_argument(
        fmt::format("the recording has {} axes, there is no axis {}", axes, options.axis));
  }
  if (rows.width(force_column(rows)) == 0)
    throw std::invalid_argument("the recording holds no force; cycles are found in angle and force");
  if (rows.rows() < 10) throw std::invalid_argument("the recording is too short for a cycle");
}

/// Appends the four phases of every closing.
void add_phases(std::vector<schema::PhaseSpan>& phases, const AxisMotion& motion,
                const std::vector<Turn>& turns, double dwell) {
  std::uint32_t cycle = 0;
  std::uint64_t free_from = 0;  // first row that no phase has yet
  const auto add = [&](schema::Phase phase, std::uint64_t begin, std::uint64_t end) {
    if (end > begin) phases.push_back({.cycle = cycle, .phase = phase, .begin = begin, .end = end});
  };
  const auto stroke = [&](std::size_t turn) {
    return stroke_between(motion, turns[turn], turns[turn + 1], dwell);
  };
  const std::size_t first_open = turns.front().closed ? 1 : 0;
  if (first_open == 1) free_from = stroke(0).end;  // an opening before the first closing belongs to no cycle
  for (std::size_t i = first_open; i + 1 < turns.size(); i += 2) {
    ++cycle;
    const StrokeRows closing = stroke(i);
    add(schema::Phase::open_to_close, free_from, closing.begin);
    add(schema::Phase::closing, closing.begin, closing.end);
    const bool opens_again = i + 2 < turns.size();
    const StrokeRows opening = opens_again ? stroke(i + 1) : StrokeRows{motion.rows(), motion.rows()};
    add(schema::Phase::close_to_open, closing.end, opening.begin);
    add(schema::Phase::opening, opening.begin, opening.end);
    free_from = opening.end;
  }
}

}  // namespace

StrokeRows stroke_between(const AxisMotion& motion, const Turn& from, const Turn& to, double dwell) {
  const double height = to.position - from.position;
  const auto share = [&](std::uint64_t row) { return (motion.position(row) - from.position) / height; };
  StrokeRows stroke{.begin = from.row, .end = to.row};
  for (std::uint64_t row = from.row; row < to.row; ++row) {
    if (share(row) < dwell) stroke.begin = row;
    if (share(row) >= 1.0 - dwell) {
      stroke.end = row;
      break;
    }
  }
  return stroke;
}

std::vector<double> mean_branch(const std::vector<std::vector<double>>& branches, std::size_t points) {
  std::vector<double> mean(points, nothing);
  for (std::size_t point = 0; point < points; ++point) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const auto& branch : branches) {
      if (std::isnan(branch[point])) continue;
      sum += branch[point];
      ++count;
    }
    if (count > 0 && 2 * count >= branches.size()) mean[point] = sum / static_cast<double>(count);
  }
  return mean;
}

schema::Cycles find_cycles(const schema::RecordedRows& rows, const SegmentOptions& options) {
  check(rows, options);
  AxisMotion motion(rows, options.axis, options.corner_hz);
  const auto [least, most] = range_of(motion);
  const double height = options.prominence * (most - least);
  // A filter leaves rounding on a constant, which turns often.
  const bool moves = most - least > 1e-9 * std::max(std::abs(most), std::abs(least));
  const PositionNoise noise = noise_of(motion, rows, options.axis);
  if (moves && height < beyond_noise * noise.after()) {
    throw std::invalid_argument(fmt::format(
        "no cycle of opening and closing: the position turns by no more than its noise does, {:.3g} "
        "{} in all",
        most - least, rows.about().axes[options.axis].position_unit));
  }
  std::vector<Turn> turns = moves ? find_turns(motion, height) : std::vector<Turn>{};

  schema::Cycles cycles;
  cycles.axis = options.axis;
  cycles.filter_corner_hz = motion.corner_hz();
  cycles.closing_direction =
      options.closing_direction ? *options.closing_direction : direction_of_closing(motion, turns);
  motion.close_along(cycles.closing_direction);
  if (cycles.closing_direction < 0.0) {
    for (Turn& turn : turns) turn = {.row = turn.row, .position = -turn.position, .closed = !turn.closed};
  }
  // A single stroke is a pull or a press, not a cycle: something has to come back.
  if (turns.size() < 3) {
    throw std::invalid_argument(
        fmt::format("no cycle of opening and closing: the position turns {} times by {:.0f} % of its range; "
                    "--prominence changes it",
                    turns.size() < 2 ? 0 : turns.size() - 2, 100.0 * options.prominence));
  }
  std::vector<double> open;
  std::vector<double> open_ends;
  std::vector<double> closed;
  for (const Turn& turn : turns) {
    (turn.closed ? closed : open).push_back(turn.position);
    if (!turn.closed) open_ends.push_back(open_end(motion, turn, noise));
  }
  cycles.contact_position = cycles.closing_direction * median(open_ends);
  const double begin = median(open);  // of the low-passed path, which the branches are of
  const double end = *std::max_element(closed.begin(), closed.end());
  for (std::size_t point = 0; point < options.points; ++point) {
    const double share = static_cast<double>(point) / static_cast<double>(options.points - 1);
    cycles.grid.push_back(cycles.closing_direction * (begin + share * (end - begin)));
  }
  if (cycles.closing_direction < 0.0) std::reverse(cycles.grid.begin(), cycles.grid.end());
  add_phases(cycles.phases, motion, turns, options.dwell);
  average_branches(cycles, motion);
  return cycles;
}

schema::Cycles find_cycles(const schema::Recording& recording, const SegmentOptions& options) {
  return find_cycles(schema::RowsInMemory(recording), options);
}

void segment_recording(schema::Recording& recording, const schema::RecordedRows& rows,
                       const SegmentOptions& options, const std::string& name) {
  try {
    recording.cycles = find_cycles(rows, options);
    recording.cycle_flags.reset();  // which were of other cycles
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", name, error.what()));
  }
  add_history(recording.header,
              fmt::format("segment: {} cycles along {}, prominence {:g}, zero-phase low-pass {:g} Hz",
                          recording.cycles->closing.size(), recording.axes[options.axis].name,
                          options.prominence, recording.cycles->filter_corner_hz));
}

}  // namespace kerf::bench
