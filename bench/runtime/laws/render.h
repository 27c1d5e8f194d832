#pragma once

#include <vector>

#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

namespace kerf::bench {

/// One axis of a recording as a law sees it: penetration, velocity and resisting force, one a row.
struct AxisSeries {
  std::vector<double> time_s;
  std::vector<double> penetration;
  std::vector<double> velocity;
  std::vector<double> force;
  std::vector<std::uint32_t> cycle;  ///< cycle of each row, 0 for none; empty if the recording has no cycles
};

/// A force as it resists engagement: a sensor gives it as it is, a command pushes against the direction of
/// engagement.
[[nodiscard]] double resisting(double force, bool is_measured, const models::Contact& contact);

/// Takes the series of an axis out of a recording; the force is the measured one where there is a sensor,
/// else the commanded one with its sign turned to resisting. @throws std::invalid_argument (no such axis).
[[nodiscard]] AxisSeries axis_series(const schema::Recording& recording, std::size_t axis,
                                     const models::Contact& contact);

/// The contact of a recording: that of the tissue in its scene if it was simulated, else the onset that
/// `kerf prepare` found, else from its cycles if it was segmented, else the smallest position with direction
/// +1.
[[nodiscard]] models::Contact contact_of(const schema::Recording& recording, std::size_t axis);

/// The law without the rendering aids of a BranchSelector (velocity filter, ramp band, reversal scaling):
/// what its tables say themselves.
[[nodiscard]] models::Law without_rendering_aids(const models::Law& law);

/// The force that a law gives along a series, tick by tick from a fresh state.
[[nodiscard]] std::vector<double> render(const models::Law& law, const AxisSeries& series);

}  // namespace kerf::bench
