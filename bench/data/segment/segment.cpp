#include "segment/segment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include "recordings/provenance.h"
#include "signal/quantiles.h"
#include "signal/signal.h"
#include "signal/uniform_samples.h"

namespace kerf::bench {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// One axis, low-passed, with the position counted positive in the direction of closing.
struct Motion {
  std::vector<double> position;
  std::vector<double> force;
};

/// A turning point of the motion.
struct Turn {
  std::size_t row = 0;
  bool closed = false;  ///< the most closed point between two openings, else the most open one
};

std::vector<double> axis_of(const std::vector<double>& values, const schema::Recording& recording,
                            std::size_t axis) {
  std::vector<double> one;
  for (std::size_t i = axis; i < values.size(); i += recording.dimensions()) one.push_back(values[i]);
  return one;
}

/// Turning points whose prominence is at least `height`, alternately closed and open.
std::vector<Turn> find_turns(const std::vector<double>& position, double height) {
  std::vector<Turn> turns;
  std::size_t highest = 0;
  std::size_t lowest = 0;
  int direction = 0;  // of the stroke under way, unknown at first
  for (std::size_t row = 0; row < position.size(); ++row) {
    if (position[row] > position[highest]) highest = row;
    if (position[row] < position[lowest]) lowest = row;
    if (direction >= 0 && position[highest] - position[row] >= height) {
      turns.push_back({.row = highest, .closed = true});
      direction = -1;
      lowest = row;
    } else if (direction <= 0 && position[row] - position[lowest] >= height) {
      turns.push_back({.row = lowest, .closed = false});
      direction = 1;
      highest = row;
    }
  }
  if (direction != 0) turns.push_back({.row = direction > 0 ? highest : lowest, .closed = direction > 0});
  return turns;
}

/// Where a stroke between two turns leaves the first and comes to the second, by `dwell` of its height.
struct Stroke {
  std::size_t begin = 0;
  std::size_t end = 0;
};

Stroke stroke_between(const std::vector<double>& position, std::size_t from, std::size_t to, double dwell) {
  const double height = position[to] - position[from];
  const auto share = [&](std::size_t row) { return (position[row] - position[from]) / height; };
  Stroke stroke{.begin = from, .end = to};
  for (std::size_t row = from; row < to; ++row) {
    if (share(row) < dwell) stroke.begin = row;
    if (share(row) >= 1.0 - dwell) {
      stroke.end = row;
      break;
    }
  }
  return stroke;
}

/// The work done along strokes that raise the position, less that along those that lower it.
double work_of_rising(const Motion& motion, const std::vector<Turn>& turns) {
  double rising = 0.0;
  double falling = 0.0;
  for (std::size_t i = 1; i < turns.size(); ++i) {
    double work = 0.0;
    for (std::size_t row = turns[i - 1].row + 1; row <= turns[i].row; ++row) {
      work += motion.force[row] * std::abs(motion.position[row] - motion.position[row - 1]);
    }
    (turns[i].closed ? rising : falling) += work;
  }
  return rising - falling;
}

/// Mean force of the rows of a stroke at each grid position: of the rows nearest to it, or between its
/// neighbours.
std::vector<double> on_grid(const Motion& motion, const Stroke& stroke, const std::vector<double>& grid) {
  std::vector<double> sum(grid.size(), 0.0);
  std::vector<double> count(grid.size(), 0.0);
  const double step = (grid.back() - grid.front()) / static_cast<double>(grid.size() - 1);
  for (std::size_t row = stroke.begin; row < stroke.end; ++row) {
    const double place = (motion.position[row] - grid.front()) / step;
    if (!(place > -0.5 && place < static_cast<double>(grid.size()) - 0.5)) continue;
    const auto cell = static_cast<std::size_t>(std::lround(std::max(place, 0.0)));
    sum[cell] += motion.force[row];
    count[cell] += 1.0;
  }
  std::vector<double> force(grid.size(), nothing);
  std::size_t last = grid.size();
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    if (count[cell] == 0.0) continue;
    force[cell] = sum[cell] / count[cell];
    for (std::size_t between = last + 1; last < grid.size() && between < cell; ++between) {
      const double share = static_cast<double>(between - last) / static_cast<double>(cell - last);
      force[between] = force[last] + share * (force[cell] - force[last]);
    }
    last = cell;
  }
  return force;
}

void check(const schema::Recording& recording, const SegmentOptions& options,
           const std::vector<double>& position, const std::vector<double>& force) {
  if (options.axis >= recording.dimensions()) {
    throw std::invalid_argument(
        fmt::format("the recording has {} axes, there is no axis {}", recording.dimensions(), options.axis));
  }
  if (force.empty())
    throw std::invalid_argument("the recording holds no force; cycles are found in angle and force");
  if (position.size() < 10) throw std::invalid_argument("the recording is too short for a cycle");
  for (std::size_t row = 0; row < position.size(); ++row) {
    if (!std::isfinite(position[row]) || !std::isfinite(force[row])) {
      throw std::invalid_argument(
          fmt::format("row {} is not finite; 'kerf prepare --drop-gaps' leaves such rows out", row));
    }
  }
}

/// Appends the four phases of every closing to `cycles.phases` and its branches to the grids.
void add_cycles(schema::Cycles& cycles, const Motion& motion, const std::vector<Turn>& turns, double dwell) {
  std::uint32_t cycle = 0;
  std::size_t free_from = 0;  // first row that no phase has yet
  const auto add = [&](schema::Phase phase, std::size_t begin, std::size_t end) {
    if (end > begin) cycles.phases.push_back({.cycle = cycle, .phase = phase, .begin = begin, .end = end});
  };
  std::vector<double> grid = cycles.grid;
  for (double& position : grid) position *= cycles.closing_direction;
  const bool turned = grid.front() > grid.back();
  if (turned) std::reverse(grid.begin(), grid.end());
  const auto branch = [&](const Stroke& along) {
    auto force = on_grid(motion, along, grid);
    if (turned) std::reverse(force.begin(), force.end());
    return force;
  };
  const auto stroke = [&](std::size_t turn) {
    return stroke_between(motion.position, turns[turn].row, turns[turn + 1].row, dwell);
  };
  const std::size_t first_open = turns.front().closed ? 1 : 0;
  if (first_open == 1) free_from = stroke(0).end;  // an opening before the first closing belongs to no cycle
  for (std::size_t i = first_open; i + 1 < turns.size(); i += 2) {
    ++cycle;
    const Stroke closing = stroke(i);
    add(schema::Phase::open_to_close, free_from, closing.begin);
    add(schema::Phase::closing, closing.begin, closing.end);
    cycles.closing.push_back(branch(closing));
    const bool opens_again = i + 2 < turns.size();
    const Stroke opening =
        opens_again ? stroke(i + 1) : Stroke{motion.position.size(), motion.position.size()};
    add(schema::Phase::close_to_open, closing.end, opening.begin);
    add(schema::Phase::opening, opening.begin, opening.end);
    cycles.opening.push_back(branch(opening));
    free_from = opening.end;
  }
}

}  // namespace

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

schema::Cycles find_cycles(const schema::Recording& recording, const SegmentOptions& options) {
  const auto position = axis_of(recording.position, recording, options.axis);
  const auto force =
      axis_of(recording.force_measured.empty() ? recording.force_commanded : recording.force_measured,
              recording, options.axis);
  check(recording, options, position, force);
  const UniformSamples samples(recording.time);
  const double corner_hz = std::min(options.corner_hz, 0.2 * samples.rate_hz());
  const auto smooth = [&](const std::vector<double>& uniform) {
    return low_pass_zero_phase(uniform, samples.rate_hz(), corner_hz);
  };
  Motion motion{.position = samples.filtered(position, smooth), .force = samples.filtered(force, smooth)};
  const auto [least, most] = std::minmax_element(motion.position.begin(), motion.position.end());
  const double height = options.prominence * (*most - *least);
  // A filter leaves rounding on a constant, which turns often.
  const bool moves = *most - *least > 1e-9 * std::max(std::abs(*most), std::abs(*least));
  std::vector<Turn> turns = moves ? find_turns(motion.position, height) : std::vector<Turn>{};

  schema::Cycles cycles;
  cycles.axis = options.axis;
  cycles.filter_corner_hz = corner_hz;
  cycles.closing_direction =
      options.closing_direction.value_or(work_of_rising(motion, turns) >= 0.0 ? 1.0 : -1.0);
  for (double& p : motion.position) p *= cycles.closing_direction;
  if (cycles.closing_direction < 0.0) {
    for (Turn& turn : turns) turn.closed = !turn.closed;
  }
  // A single stroke is a pull or a press, not a cycle: something has to come back.
  if (turns.size() < 3) {
    throw std::invalid_argument(
        fmt::format("no cycle of opening and closing: the position turns {} times by {:.0f} % of its range; "
                    "--prominence changes it",
                    turns.size() < 2 ? 0 : turns.size() - 2, 100.0 * options.prominence));
  }
  std::vector<double> open;
  std::vector<double> closed;
  for (const Turn& turn : turns) (turn.closed ? closed : open).push_back(motion.position[turn.row]);
  cycles.contact_position = cycles.closing_direction * median(open);
  const double end = *std::max_element(closed.begin(), closed.end());
  for (std::size_t point = 0; point < options.points; ++point) {
    const double share = static_cast<double>(point) / static_cast<double>(options.points - 1);
    cycles.grid.push_back(cycles.contact_position +
                          share * (cycles.closing_direction * end - cycles.contact_position));
  }
  if (cycles.closing_direction < 0.0) std::reverse(cycles.grid.begin(), cycles.grid.end());
  add_cycles(cycles, motion, turns, options.dwell);
  cycles.closing_mean = mean_branch(cycles.closing, options.points);
  cycles.opening_mean = mean_branch(cycles.opening, options.points);
  return cycles;
}

void segment_recording(schema::Recording& recording, const SegmentOptions& options, const std::string& name) {
  try {
    recording.cycles = find_cycles(recording, options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", name, error.what()));
  }
  add_history(recording.header,
              fmt::format("segment: {} cycles along {}, prominence {:g}, zero-phase low-pass {:g} Hz",
                          recording.cycles->closing.size(), recording.axes[options.axis].name,
                          options.prominence, recording.cycles->filter_corner_hz));
}

}  // namespace kerf::bench
