#include "recordings/axis_series.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

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

double resisting(double force, bool is_measured, const models::Contact& contact) {
  return is_measured ? force : -contact.direction * force;
}

AxisSeries axis_series(const schema::Recording& recording, std::size_t axis, const models::Contact& contact) {
  const std::size_t dimensions = recording.dimensions();
  if (axis >= dimensions) throw std::invalid_argument("the recording has no such axis");
  const bool measured = !recording.force_measured.empty();
  const auto& force = measured ? recording.force_measured : recording.force_commanded;
  if (force.empty()) throw std::invalid_argument("the recording holds no force");

  AxisSeries series;
  series.time_s = recording.time;
  for (auto* column : {&series.penetration, &series.velocity, &series.force})
    column->reserve(recording.rows());
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const std::size_t at = row * dimensions + axis;
    const models::Motion motion = contact.motion(recording.position[at], recording.velocity[at]);
    series.penetration.push_back(motion.penetration);
    series.velocity.push_back(motion.velocity);
    series.force.push_back(resisting(force[at], measured, contact));
  }
  if (recording.cycles && recording.cycles->axis == axis) {  // those of another axis are none along this one
    series.cycle.assign(recording.rows(), 0);
    for (const schema::PhaseSpan& phase : recording.cycles->phases) {
      if (phase.begin > phase.end || phase.end > recording.rows())
        throw schema::FormatError(
            fmt::format("/cycles: a phase of cycle {} has rows {} to {} of {}; run 'kerf segment' again",
                        phase.cycle, phase.begin, phase.end, recording.rows()));
      std::fill(series.cycle.begin() + static_cast<std::ptrdiff_t>(phase.begin),
                series.cycle.begin() + static_cast<std::ptrdiff_t>(phase.end), phase.cycle);
    }
  }
  return series;
}

AxisSeries fit_series(const schema::Recording& recording, std::size_t axis, const models::Contact& contact) {
  AxisSeries series = axis_series(recording, axis, contact);
  // What a driver gives as velocity lags behind the position; in hindsight there is a better one. Derived
  // after the rows that are not finite are gone, or each would spoil its neighbours.
  const bool lags = recording.header.velocity_derived.empty();
  if (lags) series.velocity.assign(series.velocity.size(), 0.0);
  series.left_out = keep_finite(series);
  if (lags) take_zero_phase_velocity(series);
  return series;
}

AxisSeries pooled(const std::vector<AxisSeries>& all) {
  AxisSeries together;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (const AxisSeries& one : all) {
    append(together.time_s, one.time_s);
    append(together.penetration, one.penetration);
    append(together.velocity, one.velocity);
    append(together.force, one.force);
    append(together.counts, one.counts);
    together.counts.resize(together.force.size(), 1);
  }
  return together;
}

}  // namespace kerf::bench
