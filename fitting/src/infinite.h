#pragma once

#include <limits>

namespace kerf::fitting {

/// What is not determined, not bounded or not yet found.
inline constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace kerf::fitting
