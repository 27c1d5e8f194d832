#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

namespace kerf::psychophysics {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

inline double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

inline double normal_probability(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// Infinite at 0 and 1.
inline double normal_quantile(double p) {
  if (p <= 0.0) return -infinite;
  if (p >= 1.0) return infinite;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * p);
}

}  // namespace kerf::psychophysics
