#pragma once

#include <vector>

#include "blade/blade_field.h"
#include "blade/blade_peaks.h"

namespace kerf::fitting {

/// Rows [begin, end) in which the tissue holds elastically, or is cut.
struct BladePhase {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool elastic = false;
  bool follows_another = false;   ///< it began with a jump, not with the contact or the recording
  bool anchor_may_shift = false;  ///< where it began to hold is known to a row only
  double shift = 0.0;             ///< of the anchor [rows]
};

/// The first row after a jump may still be of the phase before: the tissue changed within it.
[[nodiscard]] inline std::size_t first_fitted_row(const BladePhase& phase) noexcept {
  return phase.begin + (phase.follows_another && phase.end - phase.begin > 4 ? 1 : 0);
}

/// Phases, and the fields that were fitted to them.
struct PhaseFit {
  std::vector<BladePhase> phases;
  FieldFit viscous;
  FieldFit elastic;
  std::vector<Vector6d> residuals;  ///< of every row; zero out of the tissue
  std::size_t elastic_rows = 0;
  std::size_t cutting_rows = 0;
  std::size_t iterations = 0;
  bool settled = false;
};

/// Divides the time in the tissue into phases and fits a field to each kind, as fit_blade() says.
[[nodiscard]] PhaseFit fit_phases(const BladeRows& rows, const BladeFitOptions& options);

}  // namespace kerf::fitting
