#pragma once

#include <string>

#include "profiles/limits.h"
#include "ruptures/rupture_cell.h"
#include "starts/search.h"

namespace kerf::fitting {

/// A solution of a law that ruptures, as a Kelvin element between the rows that do.
struct BetweenRuptures {
  BetweenRuptures(const Problem& problem, const Samples& samples, const Weights& weights,
                  const Solution& solution, const RobustLoss& loss);

  /// Least squares of the element alone, whatever the line.
  [[nodiscard]] Solution alone(const RobustLoss& loss) const;

  BreakingSamples data;
  RuptureLine line;
  RuptureRows rows;
  RuptureParts parts;
  Eigen::VectorXd at;  ///< logarithms of the element
  bool one_line;       ///< one rule, whose threshold is a line over the speed
};

/// What the rows that rupture say of the line over the speed at which they do.
struct ByRuptures {
  std::string doubt;  ///< why nobody can say; empty: there is none
  Limits per_speed, constant;
  double quantile = 1.0;

  /// Half of an interval over the quantile.
  [[nodiscard]] double std_error(const Limits& limits) const {
    return 0.5 * (limits.upper - limits.lower) / quantile;
  }
};

/// Slope and constant move no force but by which rows rupture. An interval is that of all values by which the
/// same rows do, with elements that least squares does not rule out: the others following, the rise of the
/// sum of squares is less than t standard errors. It says nothing where other rows would leave as little, or
/// where the element itself is not where its own least squares are.
/// @param least the sum of squares of the element alone, whatever ruptures
[[nodiscard]] ByRuptures limits_by_ruptures(const BetweenRuptures& between, const RobustLoss& loss,
                                            double least, const Uncertainty& uncertainty);

}  // namespace kerf::fitting
