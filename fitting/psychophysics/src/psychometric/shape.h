#pragma once

#include <algorithm>
#include <cmath>

#include <kerf/psychophysics/psychometric.h>

#include "normal.h"

// The three distributions on their standard axis z: both tails apart, since each has an end where the other
// rounds.

namespace kerf::psychophysics {

struct ShapeAt {
  double below = 0.0;    ///< F
  double above = 0.0;    ///< 1 - F
  double density = 0.0;  ///< dF/dz
};

inline ShapeAt shape_at(Shape shape, double z) {
  if (z == -HUGE_VAL) return {.below = 0.0, .above = 1.0, .density = 0.0};
  z = std::clamp(z, -700.0, 700.0);
  if (shape == Shape::weibull) {
    const double rate = std::exp(std::min(z, 50.0));
    return {.below = -std::expm1(-rate), .above = std::exp(-rate), .density = rate * std::exp(-rate)};
  }
  if (shape == Shape::logistic) {
    const double below = 1.0 / (1.0 + std::exp(-z));
    const double above = 1.0 / (1.0 + std::exp(z));
    return {.below = below, .above = above, .density = below * above};
  }
  return {.below = normal_probability(z), .above = normal_probability(-z), .density = normal_density(z)};
}

inline double shape_quantile(Shape shape, double p) {
  if (shape == Shape::weibull) return std::log(-std::log1p(-p));
  if (shape == Shape::logistic) return std::log(p / (1.0 - p));
  return normal_quantile(p);
}

}  // namespace kerf::psychophysics
