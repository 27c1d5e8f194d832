#include "import/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "recordings/row_figures.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

/// The new grid, without the times that lie in a gap of the old one.
struct Grid {
  std::vector<double> time;
  std::vector<std::uint64_t> tick;
};

Grid make_grid(const std::vector<double>& time, double rate_hz, double period_s) {
  Grid grid;
  const auto last = static_cast<std::uint64_t>(std::floor(time.back() * rate_hz * (1.0 + 1e-12)));
  std::size_t after = 0;
  for (std::uint64_t tick = 0; tick <= last; ++tick) {
    const double t = static_cast<double>(tick) / rate_hz;
    while (after + 1 < time.size() && time[after] < t) ++after;
    const bool in_gap = after > 0 && t < time[after] &&
                        time[after] - time[after - 1] > gap_in_periods * period_s && t > time[after - 1];
    if (in_gap) continue;
    grid.time.push_back(t);
    grid.tick.push_back(tick);
  }
  return grid;
}

std::vector<double> resampled(const std::vector<double>& time, const std::vector<double>& values,
                              const Grid& grid, double rate_hz, double period_s) {
  if (rate_hz * period_s > 0.8) return interpolate(time, values, grid.time);
  std::vector<double> uniform_time;
  for (std::size_t i = 0; static_cast<double>(i) * period_s <= time.back(); ++i) {
    uniform_time.push_back(static_cast<double>(i) * period_s);
  }
  const auto smooth =
      low_pass_zero_phase(interpolate(time, values, uniform_time), 1.0 / period_s, 0.4 * rate_hz);
  return interpolate(uniform_time, smooth, grid.time);
}

}  // namespace

void resample(schema::Recording& recording, double rate_hz, double period_s) {
  constexpr double max_rows = 1e8;
  if (recording.rows() < 3) throw std::invalid_argument("--resample needs at least three samples");
  const double rows = recording.time.back() * std::max(rate_hz, 1.0 / period_s);
  if (!(rows <= max_rows)) {
    throw std::invalid_argument(
        fmt::format("--resample: {:.4g} s at {:.4g} Hz are more than {:.0e} rows; is the unit of time right?",
                    recording.time.back(), std::max(rate_hz, 1.0 / period_s), max_rows));
  }
  const Grid grid = make_grid(recording.time, rate_hz, period_s);
  const auto apply = [&](std::vector<double>& values, std::string_view channel) {
    if (values.empty()) return;
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
      throw std::invalid_argument(fmt::format(
          "--resample: {} holds values that are not finite, which resampling would spread; import without it",
          channel));
    }
    values = resampled(recording.time, values, grid, rate_hz, period_s);
  };
  const auto apply_to_axes = [&](std::vector<double>& values, const std::string& channel) {
    const std::size_t dimensions = recording.dimensions();
    if (dimensions == 1 || values.empty()) return apply(values, channel);
    std::vector<double> all(grid.time.size() * dimensions, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t axis = 0; axis < dimensions; ++axis) {
      std::vector<double> along(recording.rows());
      for (std::size_t row = 0; row < along.size(); ++row) along[row] = values[row * dimensions + axis];
      // No sensor is behind an axis without a number.
      if (std::ranges::none_of(along, [](double v) { return std::isfinite(v); })) continue;
      apply(along, fmt::format("{}.{}", channel, recording.axes[axis].name));
      for (std::size_t row = 0; row < along.size(); ++row) all[row * dimensions + axis] = along[row];
    }
    values = std::move(all);
  };
  apply_to_axes(recording.position, "position");
  apply_to_axes(recording.velocity, "velocity");
  apply_to_axes(recording.force_commanded, "force_commanded");
  apply_to_axes(recording.force_measured, "force_measured");
  for (schema::Channel& channel : recording.channels) apply(channel.values, channel.name);
  recording.time = grid.time;
  recording.tick = grid.tick;
  recording.flags.assign(grid.time.size(), schema::flag_resampled);
}

}  // namespace kerf::bench
