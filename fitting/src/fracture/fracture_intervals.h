#pragma once

#include <string>
#include <vector>

#include "profiles/limits.h"
#include "starts/search.h"

namespace kerf::fitting {

/// What the rows that break say of a Fracture, coordinate by coordinate.
struct ByEvents {
  std::vector<Limits> limits;
  std::vector<double> std_error;  ///< on the search scale; NaN where the other rules stand
  std::string warning;            ///< empty where one choice of the rows that break stands out
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
///
/// A law that misfits has further minima, far from the best one. Those that the search met are choices too,
/// with what lies about them, as long as their sum of squares rises by less than t^2 u + 2 t sqrt(u D), u the
/// mean square that is left times its correlation time, D the sum of squares between the two forces: what
/// noise of that strength lets it rise by, where neither is true. After [Vuong1989].
[[nodiscard]] ByEvents limits_by_events(const Problem& problem, const Samples& samples,
                                        const Weights& weights, const Solution& solution,
                                        const RobustLoss& loss, const Linearisation& linear,
                                        const Uncertainty& uncertainty, double confidence);

}  // namespace kerf::fitting
