#pragma once

#include <span>

#include <kerf/psychophysics/psychometric_fit.h>

#include "psychometric/likelihood.h"

namespace kerf::psychophysics {

/// Between intensities and an axis on which the levels span 0 to 1.
struct ScaledAxis {
  Axis axis = Axis::linear;
  double first = 0.0;
  double span = 1.0;

  /// Infinite ends become those of the axis.
  [[nodiscard]] double intensity(double scaled) const;
};

struct ScaledProblem {
  Problem problem;
  ScaledAxis axis;
};

/// Throws std::invalid_argument for levels or options that cannot be fitted.
[[nodiscard]] ScaledProblem scaled_problem(std::span<const Level> levels, const FitOptions& options);

struct FoundCurve {
  Maximum maximum;
  double deviance = 0.0;
};

/// The estimate alone, without intervals.
[[nodiscard]] FoundCurve best_curve(const ScaledProblem& scaled, const FitOptions& options);

}  // namespace kerf::psychophysics
