#pragma once

#include <cstddef>
#include <string>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

#include "plot/plot.h"
#include "signal/blocked_values.h"

namespace kerf::bench {

/// Angles are drawn in degrees and lengths in millimetres, which is what a reader thinks in.
struct DrawnUnit {
  double factor = 1.0;  ///< drawn value = factor * value in SI
  std::string unit;
};
[[nodiscard]] DrawnUnit drawn_position(const schema::Axis& axis);

/// The same time stands at the same place in every chart over it: below one another they align.
void align_times(Chart& chart, double first_s, double last_s);

/// A few thousand points of so many, no spike lost; x and y times a factor each.
[[nodiscard]] Curve drawn_curve(const BlockedValues& x, double x_factor, const BlockedValues& y,
                                double y_factor);

// `about` says all but the rows; of these some are looked at at a time, and of the points that are too many
// for a chart each stretch keeps its smallest and its largest.

/// Position of an axis over time, with the phases of its cycles as bands if it was segmented.
[[nodiscard]] Chart position_chart(const schema::Recording& about, const schema::RecordedRows& rows,
                                   std::size_t axis);

/// Force of an axis over time: measured and commanded, as far as there are.
[[nodiscard]] Chart force_chart(const schema::Recording& about, const schema::RecordedRows& rows,
                                std::size_t axis);

/// Force against position: every closing and opening, or sixty of each where there are more, and their
/// averages over them if it was segmented.
[[nodiscard]] Chart loop_chart(const schema::Recording& about, const schema::RecordedRows& rows,
                               std::size_t axis);

}  // namespace kerf::bench
