#pragma once

#include <optional>
#include <vector>

#include "starts/arm_sums.h"
#include "starts/search.h"

namespace kerf::fitting {

/// Where the sum of squares of a generalised Maxwell law is least, by sums: no step of the search runs
/// through the samples, so that every start is gone on from.
struct LeastSums {
  std::optional<Solution>
      least{};  ///< none where the weights are no such choice of folds as sums are kept of
  /// Whether the law leaves there what its sums say, and lets go nearly where it was expected to: it may else
  /// be less elsewhere.
  bool sure = false;
};
[[nodiscard]] LeastSums least_by_sums(const Problem& problem, const Samples& samples, const Weights& weights,
                                      const ArmSums& sums, const LetGo& expected, double function_tolerance);

/// Where there is next to no force: there most laws let go.
[[nodiscard]] LetGo slack(const Problem& problem, const Samples& samples);

/// Where a law lets go.
[[nodiscard]] LetGo let_go_of(const Problem& problem, const Samples& samples,
                              const std::vector<double>& values);

}  // namespace kerf::fitting
