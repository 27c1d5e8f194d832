#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "chart/cost/cold_cost.h"
#include "chart/cost/timed_ticks.h"

namespace kerf::bench {

/// What one tick of a law costs in the loop [ns], over the ticks that count (counted_ticks()).
struct TickCost {
  double p50_ns = 0.0;
  double p999_ns = 0.0;
  ColdCost cold;             ///< with caches that hold none of the law's data
  double mean_rounds = 0.0;  ///< mean over the whole path, in rounds of the calibration loop
};

struct TickCostOptions {
  std::size_t rounds = 25;
  std::size_t cold_ticks = ticks_for_p99;   ///< a law; 0: the cold costs are not measured and NaN
  double max_seconds = 0.25;                ///< a law: fewer rounds, but two at least, where they take longer
  const std::atomic<bool>* stop = nullptr;  ///< ends early, without a result
  std::function<void(double share)> told;   ///< how much of it is done
};

/// Measures laws side by side, one cost each in their order; none if it was stopped.
///
/// A tick is what the loop does: LawRendering, between two time stamps that nothing may pass, less what an
/// empty body costs between them in the same round. Laws take turns, round by round, another one first in
/// each, each along its whole path from a fresh state. A neighbour on the same core slows whole rounds, by
/// half or more, so that the cost p50 is the lowest tenth of its medians in the rounds; the others are the
/// median of their percentiles. Nothing is allocated between the stamps. Cold: cold_cost.h.
///
/// In rounds: the whole path without a stamp between its ticks, so that they overlap as the processor likes,
/// over a loop of multiplications, divisions and square roots that it cannot shorten and that takes its turn
/// in every round. This tells more of the law than of the machine.
///
/// Time stamps are those of the processor, whose rate is taken from the monotonic clock over the whole
/// measurement; where there are none, the clock's own. Where they come in steps (10 ns on some processors) a
/// median is the mean of the durations within a step of it, which is finer; a 99.9th percentile is not.
/// @throws std::invalid_argument for an empty path or a period that is not positive.
[[nodiscard]] std::vector<TickCost> tick_costs(std::span<const TimedLaw> laws,
                                               const TickCostOptions& options = {});

}  // namespace kerf::bench
