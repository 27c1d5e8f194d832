#pragma once

#include <vector>

#include <Eigen/Core>

#include "uncertainty/blocks.h"

namespace kerf::fitting {

/// A covariance in which every cycle is one observation.
struct ByCycles {
  Eigen::MatrixXd covariance;              ///< p x p
  std::vector<double> degrees_of_freedom;  ///< of each estimated variance
};

/// Fewest cycles of which a covariance is made: of fewer, Student's t makes intervals that say nothing.
inline constexpr std::size_t fewest_cycles = 8;

/// Covariance of least squares from the scores of whole cycles,
///
///     B [sum_c u_c u_c^T] B^T,   u_c = (I - M_c)^(-1/2) Q_c^T r_c,   M_c = Q_c^T Q_c,   Q = J B orthonormal,
///
/// which asks nothing of the noise within a cycle but that cycles are independent of each other. What a law
/// misfits in every cycle alike adds up to nothing in a score, so that it is not taken for noise; what
/// differs from cycle to cycle is. The root allows for what the fit took out of each cycle's residuals. The
/// degrees of freedom are those of the variance if the noise were white.
///
/// Source: [BellMcCaffrey2002] (the root, "CR2", and the degrees of freedom); here by p x p matrices alone.
/// @param cycle_ends rows [0, e0), [e0, e1), ... are the cycles; the last is the number of rows
/// @param basis B, with (J^T J)^+ = B B^T
[[nodiscard]] ByCycles covariance_by_cycles(const Linearisation& linearisation, const Eigen::MatrixXd& basis);

}  // namespace kerf::fitting
