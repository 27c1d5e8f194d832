#pragma once

#include <string>
#include <string_view>

#include "problem.h"

namespace kerf::fitting {

/// Where a search ended. No values: nowhere, for the reason in the message.
struct Solution {
  Values values;
  bool converged = false;
  int iterations = 0;
  std::string message;
  double squares = 0.0;    ///< r'r there
  Eigen::MatrixXd normal;  ///< J'J of the searched coordinates near there; empty where no search has it
  /// Near further minima, of a law that may have several: one set of values each.
  Values rivals;
};

/// What a law needs before its parameters can be searched: options that follow from the data (range and loop
/// of a table, loop of a piecewise law), and which parameters are free. The number of segments, where the
/// data decide it, follows from the samples of positive weight.
[[nodiscard]] Problem make_problem(std::string_view model, const FitOptions& options, const Samples& samples,
                                   const Weights& seen, Polish polish = Polish::thorough);

struct SearchOptions {
  RobustLoss loss;
  double function_tolerance = 1e-12;
};

/// What a force leaves of weighed samples [N2], and what that of a law of these values does.
[[nodiscard]] double squares_left(const std::vector<double>& force, const Samples& samples,
                                  const Weights& weights);
[[nodiscard]] double squares_of(const Problem& problem, const Samples& samples, const Weights& weights,
                                const Values& values);

/// Finds the best parameters for weighed samples. `near` is a solution to begin at (of other weights), or
/// empty.
[[nodiscard]] Solution search(const Problem& problem, const Samples& samples, const Weights& weights,
                              const Values& near, const SearchOptions& options = {});

}  // namespace kerf::fitting
