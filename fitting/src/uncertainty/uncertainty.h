#pragma once

#include <vector>

#include <Eigen/Core>

#include "uncertainty/blocks.h"
#include "uncertainty/noise.h"
#include "uncertainty/unidentifiable.h"

namespace kerf::fitting {

/// How well least squares knows its parameters.
struct Uncertainty {
  Eigen::MatrixXd covariance;   ///< p x p; infinite variance and NaN covariances where not determined
  Eigen::MatrixXd correlation;  ///< p x p; NaN off the diagonal where not determined
  std::vector<double> degrees_of_freedom;  ///< of the estimated variances
  std::vector<double> quantile;            ///< half the width of the interval over the standard error
  std::vector<bool> determined;            ///< by the rows at all; how well, the covariance says
  double correlation_time = 1.0;           ///< of the residuals [rows]
  double effective_samples = 0.0;
  bool by_cycles = false;                               ///< the covariance is that of cycles.h
  int noise_order = 0;                                  ///< of the autoregression
  int rows_a_block = 1;                                 ///< of the time grid on which it stands
  std::vector<UnidentifiableDirection> unidentifiable;  ///< what the data cannot tell apart
};

/// Uncertainty of ordinary (weighted) least squares whose residuals are not independent. The estimate stays
/// what it is; its covariance is
///
///     (J^T J)^-1 (J^T Sigma J) (J^T J)^-1,   Sigma the covariance of the noise,
///
/// with Sigma of a stationary model of the residuals (noise.h) on the grid of time on which the derivatives
/// vary (blocks.h). J^T Sigma J = s^2 |H^T J|^2, with H the filter that makes the noise of white innovations,
/// so that nothing of size n x n is ever formed. Half the interval is Student's t times the standard error,
/// with 2 / var(log v) degrees of freedom (Satterthwaite), v the estimated variance: the estimates of the
/// noise's coefficients vary by s^2 Gamma^-1 / n, and v with them by its derivatives.
///
/// Where there are eight cycles or more, each counts as one observation instead (cycles.h).
///
/// Where the penetration is zero may have an error sigma of its own, the same for all rows of a run: what the
/// parameters follow it by, d = (J^T J)^-1 J^T df/dx sigma, adds d d^T, by Student's t with the degrees of
/// freedom of the sum (Welch-Satterthwaite).
///
/// Taken for granted: noise of one strength throughout, independent of the parameters; without cycles, what a
/// law misfits is taken for noise with a long memory, and intervals are then rather too wide. It does not see
/// an error in the position itself from row to row (the steps of an encoder), which least squares takes for
/// exact, nor noise slower than about four recordings: no recording shows that.
///
/// What fewer rows than parameters, residuals that are not finite, or a parameter without effect leave open
/// is told by infinite variances and by `determined`, never by a number.
/// Of very many blocks the noise is estimated by a part, `most_blocks` (noise.h).
/// @throws std::invalid_argument if the sizes do not fit together or a scale is not above zero.
[[nodiscard]] Uncertainty uncertainty_of(const Linearisation& linearisation, double confidence,
                                         Eigen::Index most_blocks = most_blocks_looked_at);

[[nodiscard]] Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance);

}  // namespace kerf::fitting
