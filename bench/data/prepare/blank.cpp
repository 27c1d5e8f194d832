#include "prepare/blank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "inspect/inspection.h"
#include "recordings/row_span.h"
#include "segment/segment.h"
#include "signal/filters.h"
#include "signal/quantiles.h"
#include "signal/uniform_samples.h"

namespace kerf::bench {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t points = 51;
constexpr double acceleration_corner_hz = 20.0;
constexpr double errors_above_zero = 3.0;
constexpr double most_noise = 0.1;
constexpr double felt_by_default_n = 0.05;

/// Rows of one cycle that move one way, and those of its stroke among them.
struct BlankRows {
  RowSpan all;
  RowSpan stroke;
  bool is_closing = false;
  std::size_t cycle = 0;  ///< its place among those that are used
};

std::vector<double> column_of(const std::vector<double>& values, std::size_t axes, std::size_t axis) {
  std::vector<double> one;
  one.reserve(values.size() / axes);
  for (std::size_t i = axis; i < values.size(); i += axes) one.push_back(values[i]);
  return one;
}

std::span<const double> part(const std::vector<double>& values, const RowSpan& rows) {
  return std::span(values).subspan(rows.begin, rows.end - rows.begin);
}

/// The blank with cycles of this axis and direction.
schema::Recording with_cycles(const schema::Recording& blank, std::size_t axis, double closing_direction) {
  schema::Recording segmented = blank;
  const auto& stored = blank.cycles;
  if (!stored || stored->axis != axis || stored->closing_direction != closing_direction)
    segmented.cycles = find_cycles(blank, {.axis = axis, .closing_direction = closing_direction});
  return segmented;
}

/// Sorts the cycles into those that are used and those that are not.
void choose_blank_cycles(const schema::Recording& blank, std::size_t axis, ToolForce& tool) {
  const schema::Axis& about = blank.axes[axis];
  const double felt = about.force_unit == "N" ? felt_by_default_n : felt_by_default_n * about.lever;
  const Inspection inspection = inspect(schema::RowsInMemory(blank), {.axis = axis, .felt = felt});
  for (const FlaggedCycle& cycle : inspection.cycles.cycles) {
    std::string reasons;
    for (const CycleFlag& flag : cycle.flags) {
      if (flag.fault == CycleFault::under_force) continue;
      reasons += (reasons.empty() ? "" : "; ") + flag.reason;
    }
    if (reasons.empty()) {
      tool.used.push_back(cycle.facts.number);
    } else {
      tool.left_out.push_back({.number = cycle.facts.number, .reason = reasons});
    }
  }
  if (tool.used.size() < 2) {
    throw std::invalid_argument(fmt::format(
        "{} of its {} cycles can be used, 2 are needed to tell the tool's force from its spread{}",
        tool.used.size(), inspection.cycles.cycles.size(),
        tool.left_out.empty() ? "" : "; 'kerf inspect' says what is wrong with the others"));
  }
}

void leave_out_part(const CyclePart& part, std::vector<std::uint32_t>& cycles) {
  std::vector<std::uint32_t> others;
  for (std::size_t i = 0; i < cycles.size(); ++i)
    if (i % part.parts != part.part) others.push_back(cycles[i]);
  cycles = std::move(others);
}

/// Strokes of the cycles that are used, each with its half of the wait beside it.
std::vector<BlankRows> strokes_of(const schema::Cycles& cycles, const std::vector<std::uint32_t>& used) {
  std::vector<schema::PhaseSpan> phases = cycles.phases;
  std::ranges::sort(phases, {}, &schema::PhaseSpan::begin);
  std::vector<BlankRows> strokes;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const schema::PhaseSpan& span = phases[i];
    const auto place = std::ranges::find(used, span.cycle);
    const bool closing = span.phase == schema::Phase::closing;
    if (place == used.end() || (!closing && span.phase != schema::Phase::opening)) continue;
    BlankRows rows{.all = {span.begin, span.end},
                   .stroke = {span.begin, span.end},
                   .is_closing = closing,
                   .cycle = static_cast<std::size_t>(place - used.begin())};
    const auto middle = [](const schema::PhaseSpan& wait) {
      return wait.begin + (wait.end - wait.begin) / 2;
    };
    if (closing && i > 0 && phases[i - 1].phase == schema::Phase::open_to_close)
      rows.all.begin = middle(phases[i - 1]);
    if (!closing && i + 1 < phases.size() && phases[i + 1].phase == schema::Phase::open_to_close)
      rows.all.end = middle(phases[i + 1]);
    strokes.push_back(rows);
  }
  return strokes;
}

/// Mean and spread over cycles of what their rows say at each position.
BlankBranch branch_of(const std::vector<BlankRows>& strokes, bool closing,
                      const std::vector<double>& position, const std::vector<double>& force,
                      const std::vector<double>& grid, std::size_t cycles) {
  std::vector<std::vector<double>> each;
  for (const BlankRows& rows : strokes) {
    if (rows.is_closing == closing)
      each.push_back(mean_by_position(part(position, rows.all), part(force, rows.all), grid));
  }
  BlankBranch branch;
  for (std::size_t point = 0; point < grid.size(); ++point) {
    double sum = 0.0;
    double squares = 0.0;
    double count = 0.0;
    for (const auto& one : each) {
      if (!std::isfinite(one[point])) continue;
      sum += one[point];
      count += 1.0;
    }
    const double mean = sum / count;
    for (const auto& one : each) {
      if (std::isfinite(one[point])) squares += (one[point] - mean) * (one[point] - mean);
    }
    const bool known =
        count >= std::min(2.0, static_cast<double>(cycles)) && 2.0 * count >= static_cast<double>(cycles);
    branch.mean.push_back(known ? mean : unknown);
    branch.spread.push_back(known && count > 1.0 ? std::sqrt(squares / (count - 1.0)) : unknown);
    branch.cycles.push_back(static_cast<std::size_t>(count));
  }
  return branch;
}

void take_speeds(BlankBranch& branch, const std::vector<BlankRows>& strokes, bool closing,
                 const std::vector<double>& position, const std::vector<double>& time_s) {
  branch.slowest = std::numeric_limits<double>::infinity();
  std::vector<double> speeds;
  for (const BlankRows& rows : strokes) {
    const std::size_t last = rows.stroke.end - 1;
    if (rows.is_closing != closing || last <= rows.stroke.begin) continue;
    const double speed =
        std::abs(position[last] - position[rows.stroke.begin]) / (time_s[last] - time_s[rows.stroke.begin]);
    branch.slowest = std::min(branch.slowest, speed);
    branch.fastest = std::max(branch.fastest, speed);
    speeds.push_back(speed);
  }
  branch.median_speed = speeds.empty() ? 0.0 : median(speeds);
}

/// Mean square of the acceleration in the middle halves of the waits, where nothing but noise is expected.
double waiting_square(const schema::Cycles& cycles, const std::vector<double>& acceleration) {
  double squares = 0.0;
  double count = 0.0;
  for (const schema::PhaseSpan& span : cycles.phases) {
    if (span.phase != schema::Phase::open_to_close) continue;
    const std::uint64_t quarter = (span.end - span.begin) / 4;
    for (std::uint64_t row = span.begin + quarter; row < span.end - quarter; ++row) {
      squares += acceleration[row] * acceleration[row];
      count += 1.0;
    }
  }
  return count > 0.0 ? squares / count : std::numeric_limits<double>::infinity();
}

/// Force on acceleration over the rows of the strokes, both less their means at the same position and
/// direction, so that what goes with position is no inertia.
BlankInertia inertia_of(const std::vector<BlankRows>& strokes, const std::vector<double>& position,
                        const std::vector<double>& force, const std::vector<double>& acceleration,
                        const std::vector<double>& grid, std::size_t cycles, double waiting) {
  struct Sample {
    std::size_t cell, cycle;
    double a, f;
  };
  std::vector<Sample> samples;
  std::vector<double> count(2 * grid.size(), 0.0), sum_a(2 * grid.size(), 0.0), sum_f(2 * grid.size(), 0.0);
  const double step = grid[1] - grid[0];
  double all_squares = 0.0;
  for (const BlankRows& rows : strokes) {
    for (std::size_t row = rows.stroke.begin; row < rows.stroke.end; ++row) {
      const double place = std::round((position[row] - grid.front()) / step);
      if (!(place >= 0.0 && place < static_cast<double>(grid.size())) || !std::isfinite(force[row])) continue;
      const std::size_t cell = static_cast<std::size_t>(place) + (rows.is_closing ? grid.size() : 0);
      samples.push_back({.cell = cell, .cycle = rows.cycle, .a = acceleration[row], .f = force[row]});
      count[cell] += 1.0;
      sum_a[cell] += acceleration[row];
      sum_f[cell] += force[row];
      all_squares += acceleration[row] * acceleration[row];
    }
  }
  double aa = 0.0;
  double af = 0.0;
  for (Sample& sample : samples) {
    sample.a -= sum_a[sample.cell] / count[sample.cell];
    sample.f -= sum_f[sample.cell] / count[sample.cell];
    aa += sample.a * sample.a;
    af += sample.a * sample.f;
  }
  BlankInertia inertia;
  if (!(aa > 0.0) || cycles < 2) return inertia;
  const double value = af / aa;
  std::vector<double> scores(cycles, 0.0);
  for (const Sample& sample : samples) scores[sample.cycle] += sample.a * (sample.f - value * sample.a);
  double squares = 0.0;
  for (const double score : scores) squares += score * score;
  const auto n = static_cast<double>(cycles);
  inertia.value = value;
  inertia.error = std::sqrt(squares * n / (n - 1.0)) / aa;
  inertia.noise_share = std::min(1.0, waiting * static_cast<double>(samples.size()) / all_squares);
  inertia.is_determined =
      value > errors_above_zero * *inertia.error && inertia.noise_share < most_noise && cycles >= 4;
  return inertia;
}

}  // namespace

std::vector<double> mean_by_position(std::span<const double> position, std::span<const double> values,
                                     std::span<const double> grid) {
  std::vector<double> sum(grid.size(), 0.0), count(grid.size(), 0.0);
  const double step = grid[1] - grid[0];
  for (std::size_t row = 0; row < position.size(); ++row) {
    const double place = std::round((position[row] - grid.front()) / step);
    if (!(place >= 0.0 && place < static_cast<double>(grid.size())) || !std::isfinite(values[row])) continue;
    const auto cell = static_cast<std::size_t>(place);
    sum[cell] += values[row];
    count[cell] += 1.0;
  }
  std::vector<double> mean(grid.size(), unknown);
  std::size_t last = grid.size();
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    if (count[cell] == 0.0) continue;
    mean[cell] = sum[cell] / count[cell];
    for (std::size_t between = last + 1; last < grid.size() && between < cell; ++between) {
      const double share = static_cast<double>(between - last) / static_cast<double>(cell - last);
      mean[between] = std::lerp(mean[last], mean[cell], share);
    }
    last = cell;
  }
  return mean;
}

std::vector<double> acceleration_of(const schema::Recording& recording, std::size_t axis) {
  const UniformSamples samples(recording.time, 10.0 * median_period(recording.time));
  const double rate_hz = samples.rate_hz();
  const SampledFilter low_pass({.corner_hz = std::min(acceleration_corner_hz, 0.2 * rate_hz)}, rate_hz);
  return samples.filtered(
      column_of(recording.position, recording.dimensions(), axis), [&](const std::vector<double>& uniform) {
        std::vector<double> second(uniform.size(), 0.0);
        if (uniform.size() < 3) return second;
        const std::vector<double> smooth = low_pass.run(uniform);
        for (std::size_t i = 1; i + 1 < smooth.size(); ++i)
          second[i] = (smooth[i - 1] - 2.0 * smooth[i] + smooth[i + 1]) * rate_hz * rate_hz;
        return second;
      });
}

ToolForce tool_force(const schema::Recording& blank, std::size_t axis, double closing_direction,
                     const std::optional<CyclePart>& left_out) {
  if (blank.force_measured.empty()) throw std::invalid_argument("it holds no measured force");
  const schema::Recording segmented = with_cycles(blank, axis, closing_direction);
  ToolForce tool{.closing_direction = closing_direction};
  choose_blank_cycles(segmented, axis, tool);
  if (left_out) leave_out_part(*left_out, tool.used);
  const std::vector<BlankRows> strokes = strokes_of(*segmented.cycles, tool.used);
  const std::vector<double> position = column_of(blank.position, blank.dimensions(), axis);
  std::vector<double> force = column_of(blank.force_measured, blank.dimensions(), axis);
  std::vector<double> acceleration = acceleration_of(blank, axis);
  for (double& value : acceleration) value *= closing_direction;

  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const BlankRows& rows : strokes) {
    const auto along = part(position, rows.all);
    least = std::min(least, *std::ranges::min_element(along));
    most = std::max(most, *std::ranges::max_element(along));
  }
  if (!(least < most)) throw std::invalid_argument("its strokes have no length");
  for (std::size_t point = 0; point < points; ++point)
    tool.grid.push_back(std::lerp(least, most, static_cast<double>(point) / static_cast<double>(points - 1)));

  tool.inertia = inertia_of(strokes, position, force, acceleration, tool.grid, tool.used.size(),
                            waiting_square(*segmented.cycles, acceleration));
  if (tool.inertia.is_determined) {
    for (std::size_t row = 0; row < force.size(); ++row)
      force[row] -= *tool.inertia.value * acceleration[row];
  }
  for (const bool closing : {true, false}) {
    BlankBranch& branch = closing ? tool.closing : tool.opening;
    branch = branch_of(strokes, closing, position, force, tool.grid, tool.used.size());
    take_speeds(branch, strokes, closing, position, blank.time);
  }
  return tool;
}

}  // namespace kerf::bench
