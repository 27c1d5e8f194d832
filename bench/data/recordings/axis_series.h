#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <kerf/models/motion.h>
#include <kerf/schema/recording.h>

namespace kerf::bench {

/// One axis of a recording as a law sees it, one value a row: what fits, charts, choices and pages take from
/// recordings, and what a law is rendered along.
struct AxisSeries {
  std::vector<double> time_s;
  std::vector<double> penetration;
  std::vector<double> velocity;
  std::vector<double> force;         ///< resisting
  std::vector<std::uint32_t> cycle;  ///< cycle of each row, 0 for none; empty if the recording has no cycles
  std::vector<std::uint8_t> counts;  ///< whether fits and verdicts go by a row; empty: by all
  std::size_t left_out = 0;          ///< rows of the recording that are not here
};

/// A force as it resists engagement: a sensor gives it as it is, a command pushes against the direction of
/// engagement.
[[nodiscard]] double resisting(double force, bool is_measured, const models::Contact& contact);

/// Takes the series of an axis out of a recording; the force is the measured one where there is a sensor,
/// else the commanded one with its sign turned to resisting. @throws std::invalid_argument (no such axis).
[[nodiscard]] AxisSeries axis_series(const schema::Recording& recording, std::size_t axis,
                                     const models::Contact& contact);

/// The same as fits and their reports see it: only rows that are finite, and in place of the velocity of a
/// device, which lags, the zero-phase slope of its positions (a parabola over 20 ms, at least five samples).
/// @throws std::invalid_argument (no such axis, no force).
[[nodiscard]] AxisSeries fit_series(const schema::Recording& recording, std::size_t axis,
                                    const models::Contact& contact);

/// Several one after the other, as figures over all of them need; not a series in time.
[[nodiscard]] AxisSeries pooled(const std::vector<AxisSeries>& all);

}  // namespace kerf::bench
