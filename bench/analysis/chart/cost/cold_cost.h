#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "chart/cost/timed_ticks.h"

namespace kerf::bench {

/// How many ticks have to lie beyond a percentile for it to be told: with n of them its own share is known to
/// 1 / sqrt(n), so that p99.9 of 10,000 ticks lies between the true p99.87 and p99.93 in two of three cases.
inline constexpr std::size_t ticks_beyond = 10;
inline constexpr std::size_t ticks_for_p99 = 100 * ticks_beyond;
inline constexpr std::size_t ticks_for_p999 = 1000 * ticks_beyond;

/// What a tick costs [ns] where the caches of the processor's core hold none of the law's data.
struct ColdCost {
  std::size_t ticks = 0;  ///< that were measured
  double p50_ns = 0.0;    ///< NaN without ticks
  double p99_ns = 0.0;    ///< NaN for fewer than ticks_for_p99
  double p999_ns = 0.0;   ///< NaN for fewer than ticks_for_p999
};

struct ColdCostOptions {
  std::size_t ticks = ticks_for_p99;        ///< a law
  double max_seconds = 120.0;               ///< all laws: a passage that ends later is the last
  const std::atomic<bool>* stop = nullptr;  ///< ends early, without a result
  std::function<void(double share)> told;   ///< how much of it is done
};

/// The costs of several laws, in their order, and of an empty body, which is what the machine itself adds.
struct ColdCosts {
  std::vector<ColdCost> laws;  ///< none if it was stopped
  ColdCost empty;              ///< not less the stamps
};

/// Measures laws side by side with cold caches.
///
/// Before each tick that is measured the thread reads a buffer twice as large as the last cache that the core
/// has for itself. The law's data then come from the shared cache or from memory; instructions may stay in a
/// cache of their own, and branches stay predicted. Ticks are those of counted_ticks(), a thousand at most in
/// a passage along the path, others in each, so that all have their turn; the ticks between are stepped and
/// not timed. Laws take turns, passage by passage, and the empty body has its own: what disturbs the machine
/// disturbs all. The first four ticks of a passage, all along the path, settle the law's instructions where
/// another's were, and are not counted. The median of the empty body's ticks is taken from every duration.
/// @throws std::invalid_argument as TimedTicks does.
[[nodiscard]] ColdCosts cold_costs(std::span<const TimedLaw> laws, const ColdCostOptions& options = {});

}  // namespace kerf::bench
