#include "fits/fit_series.h"

#include <algorithm>
#include <cmath>

#include "signal/signal.h"

namespace kerf::bench {
namespace {

/// Leaves out the rows that are not finite; returns how many.
std::size_t keep_finite(AxisSeries& series) {
  const auto is_finite = [&](std::size_t i) {
    return std::isfinite(series.time_s[i]) && std::isfinite(series.penetration[i]) &&
           std::isfinite(series.velocity[i]) && std::isfinite(series.force[i]);
  };
  std::size_t kept = 0;
  const std::size_t count = series.time_s.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_finite(i)) continue;
    series.time_s[kept] = series.time_s[i];
    series.penetration[kept] = series.penetration[i];
    series.velocity[kept] = series.velocity[i];
    series.force[kept] = series.force[i];
    if (!series.cycle.empty()) series.cycle[kept] = series.cycle[i];
    ++kept;
  }
  for (auto* values : {&series.time_s, &series.penetration, &series.velocity, &series.force})
    values->resize(kept);
  if (!series.cycle.empty()) series.cycle.resize(kept);
  return count - kept;
}

void take_zero_phase_velocity(AxisSeries& series) {
  if (series.time_s.size() < 5) return;
  constexpr double window_s = 0.02;
  const double period_s =
      (series.time_s.back() - series.time_s.front()) / static_cast<double>(series.time_s.size() - 1);
  series.velocity = differentiate(series.time_s, series.penetration, std::max(window_s, 4.0 * period_s));
}

}  // namespace

fitting::Series FitSeries::view(double noise_n) const {
  return {.time_s = axis.time_s,
          .penetration = axis.penetration,
          .velocity = axis.velocity,
          .force = axis.force,
          .cycle = axis.cycle,
          .noise_n = noise_n};
}

FitSeries fit_series(const schema::Recording& recording, std::size_t axis, const models::Contact& contact) {
  FitSeries series{.axis = axis_series(recording, axis, contact)};
  // What a driver gives as velocity lags behind the position; in hindsight there is a better one. Derived
  // after the rows that are not finite are gone, or each would spoil its neighbours.
  const bool lags = recording.header.velocity_derived.empty();
  if (lags) series.axis.velocity.assign(series.axis.velocity.size(), 0.0);
  series.left_out = keep_finite(series.axis);
  if (lags) take_zero_phase_velocity(series.axis);
  return series;
}

AxisSeries pooled(const std::vector<FitSeries>& all) {
  AxisSeries together;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (const FitSeries& one : all) {
    append(together.time_s, one.axis.time_s);
    append(together.penetration, one.axis.penetration);
    append(together.velocity, one.axis.velocity);
    append(together.force, one.axis.force);
  }
  return together;
}

}  // namespace kerf::bench
