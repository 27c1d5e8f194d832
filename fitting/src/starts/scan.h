#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "problem.h"

namespace kerf::fitting {

/// A law as it is linear: values(c) = base + directions c. What is not linear is in the base.
struct LinearFamily {
  Eigen::VectorXd base;
  Eigen::MatrixXd directions;
  Bounds bounds;  ///< of c
};

/// One value of what is not linear, the rest at its best, and what that leaves.
struct Start {
  std::vector<double> values;
  double sum_of_squares = 0.0;
};

/// The best member of a family, by linear least squares on the law's own step.
[[nodiscard]] Start best_of_family(const Problem& problem, const Samples& samples, const Weights& weights,
                                   const LinearFamily& family);
/// The same by sums for the law at any values, with a column for each parameter; false: there is none.
[[nodiscard]] Start best_of_family(
    const Problem& problem, const LinearFamily& family,
    const std::function<bool(const std::vector<double>& values, Sums& sums)>& sums_at);

/// What the law leaves at some values, the same in all recordings, with a column for each parameter; false:
/// there is nothing.
[[nodiscard]] bool sums_of(const Problem& problem, const Samples& samples, const Weights& weights,
                           const std::vector<double>& values, Sums& sums);

/// The parameter that a law is scanned over because it is linear in all others (models::Scan::values); none
/// of other laws, nor where it is held or recordings have it of their own.
[[nodiscard]] std::optional<std::size_t> scanned_parameter(const Problem& problem);
/// The values that it takes.
[[nodiscard]] std::vector<double> scanned_values(const Problem& problem, const Samples& samples);

/// The family of all parameters that are named linear, the others held at these values.
[[nodiscard]] LinearFamily family_of(const Problem& problem, const std::vector<double>& values,
                                     const std::vector<bool>& linear);

/// Where a search of this law begins: the best few starts, best first. Empty: the data offer none.
[[nodiscard]] std::vector<std::vector<double>> starts_of(const Problem& problem, const Samples& samples,
                                                         const Weights& weights);

}  // namespace kerf::fitting
