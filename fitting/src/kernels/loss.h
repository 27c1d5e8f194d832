#pragma once

#include <cmath>

#include "kerf/fitting/fit.h"

namespace kerf::fitting {

/// rho(r^2) and its derivative by r^2, for the losses of FitOptions.
struct RobustLoss {
  Loss kind = Loss::squares;
  double scale = 1.0;

  struct Value {
    double rho;
    double slope;
  };
  [[nodiscard]] Value operator()(double squared) const noexcept {
    const double s2 = scale * scale;
    switch (kind) {
      case Loss::squares:
        break;
      case Loss::huber: {
        if (squared <= s2) break;
        const double r = std::sqrt(squared);
        return {2.0 * scale * r - s2, scale / r};
      }
      case Loss::soft_l1: {
        const double root = std::sqrt(1.0 + squared / s2);
        return {2.0 * s2 * (root - 1.0), 1.0 / root};
      }
      case Loss::cauchy:
        return {s2 * std::log1p(squared / s2), 1.0 / (1.0 + squared / s2)};
    }
    return {squared, 1.0};
  }
};

}  // namespace kerf::fitting
