#pragma once

#include <stdexcept>
#include <string>

#include <kerf/psychophysics/binomial.h>

namespace kerf::psychophysics {

inline void require(bool holds, const std::string& otherwise) {
  if (!holds) throw std::invalid_argument(otherwise);
}

inline void require(const Count& count) {
  if (count.trials >= 0 && count.successes >= 0 && count.successes <= count.trials) return;
  throw std::invalid_argument(std::to_string(count.successes) + " successes in " +
                              std::to_string(count.trials) +
                              " trials cannot be: a count needs 0 <= successes <= trials");
}

inline void require_some(const Count& count) {
  require(count);
  if (count.trials == 0) throw std::invalid_argument("there are no trials: an estimate needs one at least");
}

/// Strictly between 0 and 1, and so no NaN either.
inline void require_probability(double value, const char* name) {
  if (value > 0.0 && value < 1.0) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                              "; it must lie between 0 and 1");
}

}  // namespace kerf::psychophysics
