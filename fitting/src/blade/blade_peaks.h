#pragma once

#include <cstddef>
#include <vector>

#include "blade/blade_rows.h"

namespace kerf::fitting {

/// A row at which the force has jumped since the row before it.
struct Jump {
  std::size_t row = 0;
  Vector6d before = Vector6d::Zero();  ///< the force half a row earlier, by a line through what led there
  Vector6d after = Vector6d::Zero();   ///< and by a line through what came of it
  double error_n = 0.0;                ///< standard error of the force in either, the largest of x, y, z
};

/// Standard deviation of each axis' noise, from third differences, which a smooth force has none of.
[[nodiscard]] Vector6d noise_of(const BladeRows& rows, const BladeFitOptions& options);

/// The jumps of the force while the blade is in the tissue. A line is fitted to a window before each row and
/// to one after it; where both end in the middle at forces that differ by more than `prominence` standard
/// errors, over all axes, and by more than anywhere else within a window, there is a jump. A force that only
/// bends has none.
[[nodiscard]] std::vector<Jump> find_jumps(const BladeRows& rows, const Vector6d& noise,
                                           const BladeFitOptions& options);

/// Rows of a window.
[[nodiscard]] std::size_t window_rows(const BladeRows& rows, const BladeFitOptions& options);

}  // namespace kerf::fitting
