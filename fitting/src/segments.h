#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "samples.h"

namespace kerf::fitting {

/// Which samples of a law with branches are meant: those of one branch, or all if it has no loop.
struct BranchOf {
  bool loop = false;
  bool closing = true;
};

/// For each sample whether it belongs to the branch, as the law itself decides it (sign of the velocity).
[[nodiscard]] std::vector<bool> on_branch(const Samples& samples, const BranchOf& branch);

/// Knots of the partition of the penetration into `segments` stretches with the least sum of squared
/// distances from a line in each (two lines where there is a loop): dynamic programming on a grid of 256
/// cells, so the optimum on that grid. Empty if there are too few samples for as many segments.
[[nodiscard]] std::vector<double> best_knots(const Samples& samples, const Mask& mask, std::size_t segments,
                                             bool loop);

/// Linear least squares of forces at given knots, linear in between, for one branch.
[[nodiscard]] std::vector<double> forces_at_knots(const Samples& samples, const Mask& mask,
                                                  const std::vector<double>& knots, const BranchOf& branch);

/// Normal equations of the forces at given knots: A f = r for the hat functions that interpolation is made
/// of.
struct HatEquations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
};
[[nodiscard]] HatEquations hat_equations(const Samples& samples, const Mask& mask,
                                         const std::vector<double>& knots, const BranchOf& branch);

}  // namespace kerf::fitting
