#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// The tables that interpolate the samples best, one a branch: linear, so that no search is needed. Where no
/// sample lies that counts, those before all that do say what it is; where there are none, a small roughness
/// carries the table on.
[[nodiscard]] Solution solve_tables(const Problem& problem, const Samples& samples,
                                    const Weights& of_those_that_count, const RobustLoss& loss);

/// Standard error of a table's value, and its degrees of freedom.
struct TableError {
  double std_error;
  double degrees_of_freedom;
};

/// Errors of a table's values by the spread of what 20 stretches of time contribute to each, so that they
/// allow for residuals that stay; under a robust loss each weighs as the fit weighed it. Infinite at a point
/// that samples of fewer than two stretches touch: whoever was there once cannot tell how it differs.
[[nodiscard]] std::vector<TableError> table_errors(const Problem& problem, const Samples& samples,
                                                   const Weights& given, const std::vector<double>& values,
                                                   const RobustLoss& loss);

}  // namespace kerf::fitting
