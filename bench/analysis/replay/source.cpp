#include "replay/source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include "prepare/rows.h"
#include "replay/force_noise.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr double gap_periods = 2.5;  // of the median period, where times and not ticks tell of a gap

std::vector<bool> wanted_rows(const schema::Recording& recording, const SelectOptions& options,
                              const std::string& name) {
  std::vector<bool> wanted;
  for (const double time_s : recording.time) {
    wanted.push_back((!options.from_s || time_s >= *options.from_s) &&
                     (!options.to_s || time_s <= *options.to_s));
  }
  if (options.cycles.empty()) return wanted;
  if (!recording.cycles) {
    throw std::invalid_argument(name + ": it has no cycles to choose from; 'kerf segment' finds them");
  }
  std::vector<bool> in_cycle(recording.rows(), false);
  for (const std::uint32_t cycle : options.cycles) {
    bool found = false;
    for (const schema::PhaseSpan& phase : recording.cycles->phases) {
      if (phase.cycle != cycle) continue;
      found = true;
      for (std::size_t row = phase.begin; row < phase.end; ++row) in_cycle[row] = true;
    }
    if (!found) {
      throw std::invalid_argument(
          fmt::format("{}: there is no cycle {}; it has {}", name, cycle, recording.cycles->closing.size()));
    }
  }
  for (std::size_t row = 0; row < wanted.size(); ++row) wanted[row] = wanted[row] && in_cycle[row];
  return wanted;
}

void check_rows(const schema::Recording& recording, const std::vector<bool>& wanted,
                const std::string& name) {
  const std::size_t axes = recording.dimensions();
  double last_s = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (!wanted[row]) continue;
    const double time_s = recording.time[row];
    if (!(std::isfinite(time_s) && time_s > last_s)) {
      throw std::invalid_argument(
          fmt::format("{}: row {}: the time {} s does not come after the one before; 'kerf prepare' or a new "
                      "import puts rows in order",
                      name, row, time_s));
    }
    last_s = time_s;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const double position = recording.position[row * axes + axis];
      const double velocity = recording.velocity[row * axes + axis];
      if (std::isfinite(position) && std::isfinite(velocity)) continue;
      throw std::invalid_argument(
          fmt::format("{}: row {} at {:g} s: the {} of '{}' is {}; replay other rows (--from, --to), or "
                      "leave such rows out with 'kerf prepare --drop-gaps'",
                      name, row, time_s, std::isfinite(position) ? "velocity" : "position",
                      recording.axes[axis].name, std::isfinite(position) ? velocity : position));
    }
  }
}

/// The period of the loop whose ticks give these times exactly; 0 if none does.
double grid_period_s(const schema::Recording& recording) {
  const std::size_t last = recording.rows() - 1;
  if (recording.tick[last] <= recording.tick[0]) return 0.0;
  const double rate_hz = static_cast<double>(recording.tick[last] - recording.tick[0]) /
                         (recording.time[last] - recording.time[0]);
  for (const double per_hz : {1.0, 10.0, 100.0, 1000.0, 1e6}) {
    const double period_s = 1.0 / (std::round(rate_hz * per_hz) / per_hz);
    std::size_t row = 0;
    while (row <= last && static_cast<double>(recording.tick[row]) * period_s == recording.time[row]) ++row;
    if (row > last) return period_s;
  }
  return 0.0;
}

void find_gaps(Source& source) {
  const schema::Recording& recording = source.recording;
  source.gaps.clear();
  for (std::size_t row = 1; row < recording.rows(); ++row) {
    const bool jump = recording.tick[row] > recording.tick[row - 1] + 1;
    const bool pause =
        !source.on_grid && recording.time[row] - recording.time[row - 1] > gap_periods * source.period_s;
    if (jump || pause) {
      source.gaps.push_back(
          {.after = row - 1, .begin_s = recording.time[row - 1], .end_s = recording.time[row]});
    }
  }
}

/// A recording without rows, with the columns of another that a replay needs.
schema::Recording without_rows(const schema::Recording& recording) {
  schema::Recording empty;
  empty.header = recording.header;
  empty.axes = recording.axes;
  return empty;
}

/// Appends rows of a recording, or between them, to another.
class Interpolation {
 public:
  Interpolation(const schema::Recording& from, schema::Recording& to) : from_(from), to_(to) {}

  void add(std::uint64_t tick, double time_s, std::size_t row, double share, double speed, bool with_forces) {
    to_.tick.push_back(tick);
    to_.time.push_back(time_s);
    add_row(from_.position, to_.position, row, share, 1.0);
    add_row(from_.velocity, to_.velocity, row, share, speed);
    const double scale = with_forces ? 1.0 : std::numeric_limits<double>::quiet_NaN();
    add_row(from_.force_commanded, to_.force_commanded, row, share, scale);
    add_row(from_.force_measured, to_.force_measured, row, share, scale);
  }
  void add_flags(std::uint32_t flags) { to_.flags.push_back(flags); }

  [[nodiscard]] std::uint32_t flags_of(std::size_t row) const {
    return from_.flags.empty() ? 0U : from_.flags[row];
  }

 private:
  void add_row(const std::vector<double>& from, std::vector<double>& to, std::size_t row, double share,
               double scale) const {
    if (from.empty()) return;
    const std::size_t axes = from_.dimensions();
    for (std::size_t at = row * axes; at < (row + 1) * axes; ++at) {
      to.push_back(scale * (share > 0.0 ? from[at] + share * (from[at + axes] - from[at]) : from[at]));
    }
  }

  const schema::Recording& from_;
  schema::Recording& to_;
};

std::vector<double> noise_of_each(const std::vector<double>& force, std::size_t axes) {
  std::vector<double> noise;
  std::vector<double> one(force.size() / axes);
  for (std::size_t axis = 0; axis < axes && !force.empty(); ++axis) {
    for (std::size_t row = 0; row < one.size(); ++row) one[row] = force[row * axes + axis];
    noise.push_back(noise_of(one));
  }
  return noise;
}

}  // namespace

Source select_rows(schema::Recording recording, const SelectOptions& options, const std::string& name) {
  const std::vector<bool> wanted = wanted_rows(recording, options, name);
  Source source;
  for (std::size_t row = 0; row < wanted.size(); ++row) {
    if (wanted[row]) source.row.push_back(row);
  }
  if (source.row.size() < 2) {
    throw std::invalid_argument(
        recording.rows() < 2 ? name + ": it has too few rows to replay"
                             : fmt::format("{}: fewer than two rows are chosen; it goes from {:g} to {:g} s",
                                           name, recording.time.front(), recording.time.back()));
  }
  check_rows(recording, wanted, name);
  source.from_start = wanted.front();
  source.recording = std::move(recording);
  keep_rows(source.recording, wanted);
  source.period_s = grid_period_s(source.recording);
  source.on_grid = source.period_s > 0.0;
  if (!source.on_grid) source.period_s = median_period(source.recording.time);
  find_gaps(source);
  return source;
}

Source along_axis(Source source, std::size_t axis) {
  schema::Recording& recording = source.recording;
  const std::size_t axes = recording.dimensions();
  for (auto* column :
       {&recording.position, &recording.velocity, &recording.force_commanded, &recording.force_measured}) {
    for (std::size_t row = 0; row < column->size() / axes; ++row)
      (*column)[row] = (*column)[row * axes + axis];
    column->resize(column->size() / axes);
  }
  recording.axes = {recording.axes[axis]};
  recording.cycles.reset();
  return source;
}

Source bridged(const Source& source) {
  if (source.gaps.empty()) return source;
  const schema::Recording& from = source.recording;
  Source result{.recording = without_rows(from),
                .row = {},
                .period_s = source.period_s,
                .on_grid = source.on_grid,
                .from_start = source.from_start,
                .gaps = {}};
  Interpolation rows(from, result.recording);
  std::size_t gap = 0;
  for (std::size_t row = 0; row < from.rows(); ++row) {
    const std::uint64_t tick = source.on_grid ? from.tick[row] : result.recording.rows();
    rows.add(tick, from.time[row], row, 0.0, 1.0, true);
    rows.add_flags(rows.flags_of(row));
    result.row.push_back(source.row[row]);
    if (gap == source.gaps.size() || source.gaps[gap].after != row) continue;
    ++gap;
    const double length_s = from.time[row + 1] - from.time[row];
    const auto steps = std::max<std::int64_t>(std::llround(length_s / source.period_s), 1);
    for (std::int64_t step = 1; step < steps; ++step) {
      const double share = static_cast<double>(step) / static_cast<double>(steps);
      const std::uint64_t missing = tick + static_cast<std::uint64_t>(step);
      const double time_s =
          source.on_grid ? static_cast<double>(missing) * source.period_s : from.time[row] + share * length_s;
      rows.add(missing, time_s, row, share, 1.0, false);
      rows.add_flags(schema::flag_resampled);
      result.row.push_back(source.row[row]);
    }
  }
  return result;
}

Source at_speed(const Source& source, double speed) {
  if (speed == 1.0) return source;
  const schema::Recording& from = source.recording;
  Source result{.recording = without_rows(from),
                .row = {},
                .period_s = source.period_s,
                .on_grid = true,
                .from_start = source.from_start,
                .gaps = {}};
  Interpolation rows(from, result.recording);
  const double length_s = from.time.back() - from.time.front();
  const auto last = static_cast<std::uint64_t>(std::floor(length_s / (speed * source.period_s) + 1e-9));
  std::size_t row = 0;
  std::size_t gap = 0;
  for (std::uint64_t tick = 0; tick <= last; ++tick) {
    const double now_s = from.time.front() + static_cast<double>(tick) * speed * source.period_s;
    while (row + 2 < from.rows() && from.time[row + 1] <= now_s) ++row;
    while (gap < source.gaps.size() && source.gaps[gap].after < row) ++gap;
    const double share =
        std::clamp((now_s - from.time[row]) / (from.time[row + 1] - from.time[row]), 0.0, 1.0);
    const bool in_gap = gap < source.gaps.size() && source.gaps[gap].after == row;
    if (in_gap && share > 0.0 && share < 1.0) continue;
    rows.add(tick, static_cast<double>(tick) * source.period_s, row, share, speed, true);
    rows.add_flags(rows.flags_of(row) | rows.flags_of(row + 1) | schema::flag_resampled);
    result.row.push_back(source.row[row]);
  }
  find_gaps(result);
  result.noise = {.commanded = noise_of_each(from.force_commanded, from.dimensions()),
                  .measured = noise_of_each(from.force_measured, from.dimensions())};
  return result;
}

SampledMotion motion_of(const Source& source) {
  const schema::Recording& recording = source.recording;
  const std::size_t axes = recording.dimensions();
  SampledMotion motion{.time_s = recording.time, .period_s = periods_of(recording.time), .sample = {}};
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    models::SpatialMotion& sample = motion.sample.emplace_back();
    for (std::size_t axis = 0; axis < axes; ++axis) {
      sample.position[axis] = recording.position[row * axes + axis];
      sample.velocity[axis] = recording.velocity[row * axes + axis];
    }
    if (!source.on_grid) continue;
    const std::uint64_t expected =
        row > 0 ? recording.tick[row - 1] + 1 : (source.from_start ? 0 : recording.tick[0]);
    motion.period_s[row] = static_cast<double>(recording.tick[row] + 1 - expected) * source.period_s;
  }
  if (!source.on_grid) motion.period_s.front() = source.period_s;
  return motion;
}

std::string gaps_in_words(const Source& source, bool bridge) {
  if (source.gaps.empty()) return "";
  const auto longest =
      std::ranges::max(source.gaps, {}, [](const Gap& gap) { return gap.end_s - gap.begin_s; });
  const std::string what = fmt::format(
      "{} gap{} in the recording, the longest of {:.4g} ms after {:.4g} s: ", source.gaps.size(),
      source.gaps.size() == 1 ? "" : "s", 1e3 * (longest.end_s - longest.begin_s), longest.begin_s);
  return what + (bridge ? "bridged by straight lines (--bridge)" : "kept as they are (--bridge fills them)");
}

}  // namespace kerf::bench
