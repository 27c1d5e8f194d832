#pragma once

#include "stability/several/turning_wall.h"

namespace kerf::bench {

/// A condition that is sufficient for stability of several axes with a wall, turning or not. In coordinates
/// weighted by the inertia, y = M^1/2 x, a matrix A becomes M^-1/2 A M^-1/2. The wall's stiffness is divided,
///
///     K_k = Ks + N_k,   Ks symmetric and constant, |N_k| <= nu,   and <= nu_s in the symmetric part of N_k
///
/// (Ks: the symmetric part, of a turning wall its mean over a turn; N: what is skew, and what turns). With
/// the period T, the delay t rounded up to whole periods, and the hand's stiffness S
///
///     d = least eigenvalue of  D - T/2 Ks+ - t |Ks| - (|B| + |B^T|) / 2,   less (2 T / pi + t) nu
///     k = least eigenvalue of  Ks + S,                                  less nu_s
///     c = (|Ks| + nu) (2 T / pi + t) + |B|
///
/// where Ks+ has the negative eigenvalues of Ks set to 0, |A| of a matrix is (A^T A)^1/2, and of a number's
/// place the largest singular value, the motions die away if
///
///     d > 0,  k > 0  and  2 k d > nu (c + sqrt(4 k + c^2)),
///
/// and with nu = 0 the wall gives no energy, in any hand, if d > 0 with the device's own D. Proof:
/// docs/stability.md. For one axis it is b > K T / 2 + |B| [ColgateSchenkel1997]; without sampling
/// d^2 k > nu^2, by which the polynomial l^2 + d l + k + i nu of a circulatory system is stable.
struct SufficientCondition {
  double damping_left_per_s = 0.0;     ///< d
  double stiffness_left_per_s2 = 0.0;  ///< k
  double turning_per_s2 = 0.0;         ///< nu
  double lag_per_s = 0.0;              ///< c
  [[nodiscard]] bool holds() const noexcept;
};

[[nodiscard]] SufficientCondition sufficient_condition(const SampledAxes& device, const TurningWall& wall);

}  // namespace kerf::bench
