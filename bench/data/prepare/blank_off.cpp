#include "prepare/blank_off.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

#include "prepare/blank_rows.h"
#include "prepare/rows.h"
#include "segment/segment.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();
constexpr double felt_force_n = 0.05;
constexpr double like_speeds = 1.5;  ///< ratio of median speeds beyond which a mismatch is told

std::string_view scheme_of(std::string_view uri) { return uri.substr(0, uri.find('?')); }

void require_same_tool(const schema::Recording& recording, std::size_t axis, const BlankOptions& options) {
  const schema::Recording& blank = options.recording;
  const schema::Axis& of = recording.axes[axis];
  const auto refuse = [&](std::string_view what, std::string_view theirs, std::string_view ours) {
    throw std::invalid_argument(fmt::format("--blank: {}: its {} is '{}', that of the recording is '{}'",
                                            options.file, what, theirs, ours));
  };
  if (blank.header.uuid == recording.header.uuid)
    throw std::invalid_argument(fmt::format("--blank: {}: it is the recording itself", options.file));
  if (scheme_of(blank.header.device_uri) != scheme_of(recording.header.device_uri))
    refuse("device", blank.header.device_uri, recording.header.device_uri);
  const auto found = std::ranges::find(blank.axes, of.name, &schema::Axis::name);
  if (found == blank.axes.end()) refuse("first axis", blank.axes.front().name, of.name);
  if (found->position_unit != of.position_unit)
    refuse("position unit", found->position_unit, of.position_unit);
  if (found->force_unit != of.force_unit) refuse("force unit", found->force_unit, of.force_unit);
  if (found->lever != of.lever)
    refuse("lever", fmt::format("{:g}", found->lever), fmt::format("{:g}", of.lever));
}

/// The value of a branch at a position: linear between its neighbours, the end's within half a step of it.
double at(const std::vector<double>& grid, const std::vector<double>& values, double position) {
  const double step = grid[1] - grid[0];
  const double place = (position - grid.front()) / step;
  const double last = static_cast<double>(grid.size() - 1);
  if (!(place >= -0.5 && place <= last + 0.5)) return not_there;
  const double within = std::clamp(place, 0.0, last);
  const auto below = static_cast<std::size_t>(within);
  const std::size_t above = std::min(below + 1, grid.size() - 1);
  const double share = within - static_cast<double>(below);
  if (std::isfinite(values[below]) && std::isfinite(values[above]))
    return std::lerp(values[below], values[above], share);
  return values[share <= 0.5 ? below : above];
}

void count(UncoveredRows& uncovered, double position) {
  uncovered.least = uncovered.rows == 0 ? position : std::min(uncovered.least, position);
  uncovered.most = uncovered.rows == 0 ? position : std::max(uncovered.most, position);
  ++uncovered.rows;
}

/// A value of both branches, by how much of the closing one a row has; a branch that it has nothing of is not
/// asked.
double blended(double closing_share, const ToolForce& tool, const std::vector<double>& closing,
               const std::vector<double>& opening, double position) {
  const double c = closing_share > 0.0 ? closing_share * at(tool.grid, closing, position) : 0.0;
  const double o = closing_share < 1.0 ? (1.0 - closing_share) * at(tool.grid, opening, position) : 0.0;
  return c + o;
}

std::vector<double> errors_of(const BlankBranch& branch) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < branch.spread.size(); ++i)
    errors.push_back(branch.spread[i] /
                     std::sqrt(static_cast<double>(std::max<std::size_t>(branch.cycles[i], 1))));
  return errors;
}

/// Sums over the covered rows.
class TakenSums {
 public:
  TakenSums(BlankTaken& taken, double felt) : taken_(taken), felt_(felt) {}

  void add(double position, double before, double off, double spread, double error) {
    force_ += before * before;
    off_ += off * off;
    spread_ += spread * spread;
    error_ += error * error;
    told_ += std::abs(off) > 2.0 * error ? 1.0 : 0.0;
    negative_before_ += before < 0.0 ? 1.0 : 0.0;
    negative_after_ += before - off < 0.0 ? 1.0 : 0.0;
    if (before - off < -std::max(2.0 * spread, felt_)) count(pulling_, position);
    ++taken_.covered;
  }

  void finish() {
    const auto n = static_cast<double>(std::max<std::size_t>(taken_.covered, 1));
    taken_.force_rms = std::sqrt(force_ / n);
    taken_.taken_rms = std::sqrt(off_ / n);
    taken_.spread_rms = std::sqrt(spread_ / n);
    taken_.error_rms = std::sqrt(error_ / n);
    taken_.told_share = told_ / n;
    taken_.negative_before = negative_before_ / n;
    taken_.negative_after = negative_after_ / n;
    taken_.pulling_share = static_cast<double>(pulling_.rows) / n;
    taken_.pulling_least = pulling_.least;
    taken_.pulling_most = pulling_.most;
  }

 private:
  BlankTaken& taken_;
  double felt_;
  UncoveredRows pulling_;
  double force_ = 0.0, off_ = 0.0, spread_ = 0.0, error_ = 0.0;
  double told_ = 0.0, negative_before_ = 0.0, negative_after_ = 0.0;
};

/// Where rows count that are not covered for this reason; null for those that may be.
UncoveredRows* uncovered_by(Cover cover, BlankTaken& taken) {
  switch (cover) {
    case Cover::of_no_cycle:
      return &taken.of_no_cycle;
    case Cover::too_fast:
      return &taken.too_fast;
    case Cover::too_slow:
      return &taken.too_slow;
    case Cover::yes:
      return nullptr;
  }
  return nullptr;
}

/// Takes the tool's force off the rows that it covers and counts the others. What was taken, NaN where
/// nothing was.
std::vector<double> take_from_rows(schema::Recording& recording, std::size_t axis,
                                   const std::vector<double>& position, const BlankPlaces& places,
                                   BlankTaken& taken) {
  const ToolForce& tool = taken.tool;
  const double inertia = tool.inertia.is_determined ? tool.closing_direction * *tool.inertia.value : 0.0;
  const std::vector<double> acceleration =
      inertia != 0.0 ? acceleration_of(recording, axis) : std::vector<double>(recording.rows(), 0.0);
  const std::vector<double> closing_errors = errors_of(tool.closing);
  const std::vector<double> opening_errors = errors_of(tool.opening);
  const schema::Axis& about = recording.axes[axis];
  TakenSums sums(taken, about.force_unit == "N" ? felt_force_n : felt_force_n * about.lever);
  std::vector<double> off(recording.rows(), not_there);
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const auto& [share, cover] = places.rows()[row];
    const double x = position[row];
    double& force = recording.force_measured[row * recording.dimensions() + axis];
    if (UncoveredRows* reason = uncovered_by(cover, taken)) {
      count(*reason, x);
      continue;
    }
    const double of_tool =
        blended(share, tool, tool.closing.mean, tool.opening.mean, x) + inertia * acceleration[row];
    if (!std::isfinite(of_tool) || !std::isfinite(force)) {
      count(taken.out_of_range, x);
      continue;
    }
    sums.add(x, force, of_tool, blended(share, tool, tool.closing.spread, tool.opening.spread, x),
             blended(share, tool, closing_errors, opening_errors, x));
    force -= of_tool;
    off[row] = of_tool;
  }
  sums.finish();
  return off;
}

/// What was taken off the rows of the stored branches is taken off these.
void adjust_branches(schema::Cycles& cycles, const std::vector<double>& position,
                     const std::vector<double>& off) {
  for (const schema::PhaseSpan& span : cycles.phases) {
    const bool closing = span.phase == schema::Phase::closing;
    auto& branches = closing ? cycles.closing : cycles.opening;
    if ((!closing && span.phase != schema::Phase::opening) || span.cycle < 1 ||
        span.cycle > branches.size() || cycles.grid.size() < 2)
      continue;
    const std::size_t length = span.end - span.begin;
    const auto lost = mean_by_position(std::span(position).subspan(span.begin, length),
                                       std::span(off).subspan(span.begin, length), cycles.grid);
    std::vector<double>& branch = branches[span.cycle - 1];
    for (std::size_t i = 0; i < branch.size(); ++i) {
      if (std::isfinite(lost[i])) branch[i] -= lost[i];
    }
  }
  cycles.closing_mean = mean_branch(cycles.closing, cycles.grid.size());
  cycles.opening_mean = mean_branch(cycles.opening, cycles.grid.size());
}

std::vector<RowSpan> spans_without(const std::vector<double>& off) {
  std::vector<RowSpan> spans;
  for (std::size_t row = 0; row < off.size(); ++row) {
    if (std::isfinite(off[row])) continue;
    if (spans.empty() || spans.back().end != row) spans.push_back({.begin = row, .end = row});
    spans.back().end = row + 1;
  }
  return spans;
}

void add_warnings(BlankTaken& taken, double tool_closing, double tool_opening) {
  const auto compare = [&](std::string_view stroke, double own, double blank) {
    if (!(own > 0.0 && blank > 0.0) || (own < like_speeds * blank && blank < like_speeds * own)) return;
    taken.warnings.push_back(fmt::format(
        "--blank: {} at {:.3g} {}/s (median), in the blank at {:.3g}: friction that goes with speed "
        "is not taken off rightly",
        stroke, own, taken.position_unit, blank));
  };
  compare("it closes", taken.closing_speed, tool_closing);
  compare("it opens", taken.opening_speed, tool_opening);
  if (taken.spread_rms > 0.5 * taken.taken_rms) {
    taken.warnings.push_back(
        fmt::format("--blank: what was taken off is {:.3g} {} (rms) and differs by {:.3g} {} from one cycle "
                    "of the blank to "
                    "the next: it is hardly known",
                    taken.taken_rms, taken.force_unit, taken.spread_rms, taken.force_unit));
  }
  if (taken.pulling_share > 0.01) {
    taken.warnings.push_back(fmt::format(
        "--blank: {:.1f} % of the rows pull by more than two spreads of the blank, and so that it is felt, "
        "at {:.4g} to {:.4g} {}: "
        "the "
        "tool had less friction there than in the blank",
        100.0 * taken.pulling_share, taken.pulling_least, taken.pulling_most, taken.position_unit));
  }
  const std::size_t left = taken.rows - taken.covered;
  if (left > 0) {
    taken.warnings.push_back(fmt::format("--blank: {} of {} rows are not covered by it and {}", left,
                                         taken.rows,
                                         taken.are_dropped ? "were left out" : "stay as they are"));
  }
}

ToolForce tool_of(const BlankOptions& options, const std::string& axis, double closing_direction) {
  try {
    const auto at_axis = std::ranges::find(options.recording.axes, axis, &schema::Axis::name);
    return tool_force(options.recording, static_cast<std::size_t>(at_axis - options.recording.axes.begin()),
                      closing_direction, options.left_out);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--blank: {}: {}", options.file, error.what()));
  }
}

}  // namespace

BlankTaken remove_blank(schema::Recording& recording, const BlankOptions& options) {
  if (recording.force_measured.empty())
    throw std::invalid_argument("the recording holds no measured force to take a blank off");
  const std::size_t axis = recording.cycles ? recording.cycles->axis : 0;
  const std::size_t axes = recording.dimensions();
  require_same_tool(recording, axis, options);
  const schema::Cycles cycles = recording.cycles ? *recording.cycles : find_cycles(recording, {.axis = axis});
  BlankTaken taken{.tool = tool_of(options, recording.axes[axis].name, cycles.closing_direction),
                   .axis = recording.axes[axis].name,
                   .force_unit = recording.axes[axis].force_unit,
                   .position_unit = recording.axes[axis].position_unit,
                   .file = options.file,
                   .uuid = options.recording.header.uuid,
                   .sha256 = options.sha256,
                   .rows = recording.rows(),
                   .are_dropped = options.drop};
  const ToolForce& tool = taken.tool;
  std::vector<double> position;
  for (std::size_t row = 0; row < recording.rows(); ++row)
    position.push_back(recording.position[row * axes + axis]);
  const BlankPlaces places(recording, cycles, position, tool, options.speed_factor);
  const std::vector<double> off = take_from_rows(recording, axis, position, places, taken);
  taken.closing_speed = places.median_speed(true);
  taken.opening_speed = places.median_speed(false);
  if (taken.covered == 0) {
    throw std::invalid_argument(fmt::format(
        "--blank: {}: it covers no row: {} are beyond its positions, {} in strokes that are faster and {} in "
        "strokes that are slower than its own by {:g}, {} of no cycle",
        options.file, taken.out_of_range.rows, taken.too_fast.rows, taken.too_slow.rows, options.speed_factor,
        taken.of_no_cycle.rows));
  }
  if (recording.cycles) adjust_branches(*recording.cycles, position, off);
  if (options.drop && taken.covered < taken.rows) {
    std::vector<bool> covered;
    for (const double value : off) covered.push_back(std::isfinite(value));
    keep_rows(recording, covered);
  } else {
    taken.uncovered = spans_without(off);
  }
  add_warnings(taken, tool.closing.median_speed, tool.opening.median_speed);
  return taken;
}

std::string blank_step(const BlankTaken& taken) {
  const BlankInertia& inertia = taken.tool.inertia;
  return fmt::format(
      "blank {} {} sha256:{} taken off {} of {} rows along {}: {:.4g} {} rms, spread {:.2g}, from {} cycles; "
      "inertia {}; {} rows beyond its positions, {} faster, {} slower, {} of no cycle {}",
      taken.file, taken.uuid, taken.sha256, taken.covered, taken.rows, taken.axis, taken.taken_rms,
      taken.force_unit, taken.spread_rms, taken.tool.used.size(),
      inertia.is_determined ? fmt::format("{:.4g}+-{:.2g}", *inertia.value, *inertia.error)
                            : "not determined",
      taken.out_of_range.rows, taken.too_fast.rows, taken.too_slow.rows, taken.of_no_cycle.rows,
      taken.are_dropped ? "left out" : "left as they were");
}

}  // namespace kerf::bench
