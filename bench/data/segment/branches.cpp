#include "segment/branches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include "recordings/axis_values.h"
#include "recordings/row_figures.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

constexpr double not_reached = std::numeric_limits<double>::quiet_NaN();

UniformTimes times_of_finite_rows(const schema::RecordedRows& rows, const BlockedValues& time_s,
                                  const BlockedValues& position, const BlockedValues& force) {
  for (std::uint64_t row = 0; row < position.size(); ++row) {
    if (!std::isfinite(position[row]) || !std::isfinite(force[row])) {
      throw std::invalid_argument(
          fmt::format("row {} is not finite; 'kerf prepare --drop-gaps' leaves such rows out", row));
    }
  }
  return UniformTimes(time_s, median_step(rows));
}

/// Mean force of the rows of a stroke at each grid position: of the rows nearest to it, or between its
/// neighbours.
std::vector<double> on_grid(const AxisMotion& motion, const schema::PhaseSpan& stroke,
                            const std::vector<double>& grid) {
  std::vector<double> sum(grid.size(), 0.0);
  std::vector<double> count(grid.size(), 0.0);
  const double step = (grid.back() - grid.front()) / static_cast<double>(grid.size() - 1);
  for (std::uint64_t row = stroke.begin; row < stroke.end; ++row) {
    const double place = (motion.position(row) - grid.front()) / step;
    if (!(place > -0.5 && place < static_cast<double>(grid.size()) - 0.5)) continue;
    const auto cell = static_cast<std::size_t>(std::lround(std::max(place, 0.0)));
    sum[cell] += motion.force(row);
    count[cell] += 1.0;
  }
  std::vector<double> force(grid.size(), not_reached);
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

}  // namespace

AxisMotion::AxisMotion(const schema::RecordedRows& rows, std::size_t axis, double corner_hz)
    : time_s_(axis_values(rows, schema::Column::time)),
      position_(axis_values(rows, schema::Column::position, axis)),
      force_(axis_values(rows, force_column(rows), axis)),
      grid_(times_of_finite_rows(rows, time_s_, position_, force_)),
      corner_hz_(std::min(corner_hz, 0.2 * grid_.rate_hz())),
      is_measured_(force_column(rows) == schema::Column::force_measured),
      smooth_position_(position_, grid_, corner_hz_),
      smooth_force_(force_, grid_, corner_hz_) {}

void average_branches(schema::Cycles& cycles, const AxisMotion& motion) {
  std::vector<double> grid = cycles.grid;
  for (double& position : grid) position *= cycles.closing_direction;
  const bool turned = grid.front() > grid.back();
  if (turned) std::reverse(grid.begin(), grid.end());
  std::uint32_t last = 0;
  for (const schema::PhaseSpan& phase : cycles.phases) last = std::max(last, phase.cycle);
  cycles.closing.assign(last, std::vector<double>(grid.size(), not_reached));
  cycles.opening.assign(last, std::vector<double>(grid.size(), not_reached));
  for (const schema::PhaseSpan& phase : cycles.phases) {
    const bool closes = phase.phase == schema::Phase::closing;
    if (phase.cycle == 0 || (!closes && phase.phase != schema::Phase::opening)) continue;
    auto force = on_grid(motion, phase, grid);
    if (turned) std::reverse(force.begin(), force.end());
    (closes ? cycles.closing : cycles.opening)[phase.cycle - 1] = std::move(force);
  }
  cycles.closing_mean = mean_branch(cycles.closing, grid.size());
  cycles.opening_mean = mean_branch(cycles.opening, grid.size());
}

}  // namespace kerf::bench
