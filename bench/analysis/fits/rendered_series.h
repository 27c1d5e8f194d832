#pragma once

#include <cstdint>
#include <vector>

#include <kerf/models/law.h>

#include "recordings/axis_series.h"

namespace kerf::bench {

/// A recording as a loop would meet it: ticks at the loop's rate, positions linear between the rows, the
/// velocity that drivers::VelocityFilter makes of them (20 Hz, some 8 ms late), and a force that acts one
/// period after the reading that it answers and until the next one. Ticks are no finer than a quarter of the
/// usual time between rows, since nothing is known of what lies between, but for the one a period of the loop
/// before each row, whose force is felt there; and where rows are missing for longer than 0.1 s and twenty
/// rows a single tick bridges the gap.
class RenderedSeries {
 public:
  RenderedSeries(const AxisSeries& series, double loop_rate_hz);

  /// The resisting force of a law at each row, from a fresh state.
  [[nodiscard]] std::vector<double> force(const models::Law& law) const;

 private:
  std::vector<models::Motion> motion_;
  std::vector<double> period_s_;     ///< one for all ticks, or one each
  std::vector<std::uint32_t> tick_;  ///< whose force acts at each row, none before that of the row before
};

}  // namespace kerf::bench
