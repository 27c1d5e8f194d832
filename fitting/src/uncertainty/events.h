#pragma once

#include "starts/search.h"
#include "uncertainty/limits.h"

namespace kerf::fitting {

/// What the rows that break say of a Fracture, coordinate by coordinate.
struct ByEvents {
  std::vector<Limits> limits;
  std::vector<double> std_error;  ///< on the search scale; NaN where the other rules stand
};

/// Between two samples the tissue yields at a depth that no force tells, and a yield energy (with it a
/// toughness that is only seen by how far cracks run) moves no force but by which rows break: their
/// derivatives are none, and their intervals come of the rows. By one choice of rows that break the depth of
/// yielding d lies between the deepest whole one and the shallowest that broke; there
///
///     ln U(d; alpha, beta) -+ u sqrt(g' C g),    g the derivatives of ln U, C the covariance of amplitude,
///     exponent, crack.
///
/// Choices are tried from the best one outwards, everything else at its best again, until the rise of the sum
/// of squares reaches t standard errors on either side; u^2 = t^2 - rise. An interval spans those of all
/// choices, of amplitude and exponent too where there is more than one: a profile over what is not smooth.
[[nodiscard]] ByEvents limits_by_events(const Problem& problem, const Samples& samples,
                                        const Weights& weights, const Solution& solution,
                                        const RobustLoss& loss, const Linearisation& linear,
                                        const Uncertainty& uncertainty, double confidence);

}  // namespace kerf::fitting
