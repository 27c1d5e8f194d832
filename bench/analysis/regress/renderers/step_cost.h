#pragma once

#include <string>
#include <vector>

#include <kerf/schema/regression.h>

#include "regress/forces.h"
#include "regress/renderers/outside_renderer.h"

namespace kerf::bench {

/// How long the ticks of a renderer took [s]; all zero of none.
struct StepCost {
  double median_s = 0.0;
  double near_all_s = 0.0;  ///< 99 of 100 took no longer
  double largest_s = 0.0;
};
[[nodiscard]] StepCost step_cost(std::vector<double> times_s);

/// "a tick 12.3 us, 99 of 100 within 40 us (round trip)"; empty if nothing was measured.
[[nodiscard]] std::string step_cost_in_words(const RenderedForces& got);

/// What a suite asks of the time that ticks take and does not get; none if it asks nothing.
[[nodiscard]] std::vector<std::string> judge_step_cost(const OutsideRenderer& renderer,
                                                       const schema::StoredForces& stored,
                                                       const RenderedForces& got);

}  // namespace kerf::bench
