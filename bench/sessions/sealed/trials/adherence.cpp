#include "sealed/trials/adherence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::bench {
namespace {

constexpr double lag_step_s = 0.005;
constexpr double least_likeness = 0.5;
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Of one slot, no closer than lag_step_s.
struct LedWay {
  std::vector<double> time_s;
  std::vector<double> position;

  void add(double at_s, double where) {
    if (!std::isfinite(where) || (!time_s.empty() && at_s - time_s.back() < lag_step_s - 1e-9)) return;
    time_s.push_back(at_s);
    position.push_back(where);
  }
};

/// Pearson's r; 0 where one of the two does not move.
double likeness(const std::vector<double>& one, const std::vector<double>& other) {
  const auto n = static_cast<double>(one.size());
  double mean_one = 0.0, mean_other = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    mean_one += one[i] / n;
    mean_other += other[i] / n;
  }
  double both = 0.0, of_one = 0.0, of_other = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    both += (one[i] - mean_one) * (other[i] - mean_other);
    of_one += (one[i] - mean_one) * (one[i] - mean_one);
    of_other += (other[i] - mean_other) * (other[i] - mean_other);
  }
  return of_one > 0.0 && of_other > 0.0 ? both / std::sqrt(of_one * of_other) : 0.0;
}

double lag_of(const LedWay& way, const GuidedMotion& guide) {
  if (way.time_s.size() < 3 || way.time_s.back() - way.time_s.front() < 0.5 * guide.cycle_s())
    return not_known;
  const auto earliest = static_cast<int>(std::floor(-0.25 * guide.cycle_s() / lag_step_s));
  const auto latest = static_cast<int>(std::ceil(0.5 * guide.cycle_s() / lag_step_s));
  std::vector<double> like;
  std::vector<double> target(way.time_s.size());
  for (int step = earliest; step <= latest; ++step) {
    for (std::size_t i = 0; i < target.size(); ++i)
      target[i] = guide.at(way.time_s[i] - lag_step_s * step).position;
    like.push_back(likeness(way.position, target));
  }
  const auto best = std::ranges::max_element(like);
  if (*best < least_likeness || best == like.begin() || best + 1 == like.end()) return not_known;
  const double before = *(best - 1);
  const double after = *(best + 1);
  const double bend = before - 2.0 * *best + after;
  const double refined = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
  return lag_step_s * (earliest + static_cast<double>(best - like.begin()) + refined);
}

}  // namespace

std::vector<schema::Channel> channels_of_guide(const schema::Axis& axis) {
  return {{.name = "guide_time", .unit = "s", .values = {}},
          {.name = axis.name + "_target", .unit = axis.position_unit, .values = {}},
          {.name = axis.name + "_guide_force", .unit = axis.force_unit, .values = {}}};
}

std::optional<std::size_t> led_axis_of(const RecordedTrial& trial) {
  if (trial.channels.size() != led_channels) return std::nullopt;
  for (std::size_t axis = 0; axis < trial.axes.size(); ++axis) {
    if (trial.channels[1].name == channels_of_guide(trial.axes[axis])[1].name) return axis;
  }
  return std::nullopt;
}

std::vector<double> guide_lags_s(const RecordedTrial& trial, const GuidedMotion& guide, std::size_t slots) {
  const std::optional<std::size_t> axis = led_axis_of(trial);
  std::vector<double> lags(slots, not_known);
  if (!axis || !guide.has_target()) return lags;
  std::vector<LedWay> ways(slots);
  for (const TraceRow& tick : trial.trace) {
    if (tick.slot < slots) ways[tick.slot].add(tick.row.channels[0], tick.row.position[*axis]);
  }
  for (std::size_t slot = 0; slot < slots; ++slot) lags[slot] = lag_of(ways[slot], guide);
  return lags;
}

}  // namespace kerf::bench
