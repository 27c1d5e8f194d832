#pragma once

#include <cmath>

#include <kerf/psychophysics/dprime.h>

#include "checks.h"

// What the designs of two rates share.

namespace kerf::psychophysics {

inline constexpr double largest_dprime = 14.0;  ///< d' beyond which a proportion is 1 in double precision

/// A rate; of none or all the log-linear correction, as `correction` has it.
inline double corrected(Count count, Correction correction) {
  require_some(count);
  const bool extreme = count.successes == 0 || count.successes == count.trials;
  require(!extreme || correction != Correction::none,
          "a rate of 0 or 1 has no finite z: allow the log-linear correction, or gather more trials");
  if (correction == Correction::always || (correction == Correction::extremes && extreme))
    return (count.successes + 0.5) / (count.trials + 1.0);
  return static_cast<double>(count.successes) / count.trials;
}

inline double log_probability(Count count, double rate) {
  double sum = 0.0;
  if (count.successes > 0) sum += count.successes * std::log(std::max(rate, 1e-300));
  if (count.successes < count.trials)
    sum += (count.trials - count.successes) * std::log(std::max(1.0 - rate, 1e-300));
  return sum;
}

}  // namespace kerf::psychophysics
