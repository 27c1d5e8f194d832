#pragma once

#include <span>
#include <vector>

namespace kerf::compare {

/// Weights of columns whose sum is nearest to a target, by least squares; zero of columns that say nothing of
/// their own. All are of one length.
[[nodiscard]] std::vector<double> nearest_sum(const std::vector<std::vector<double>>& columns,
                                              std::span<const double> target);

}  // namespace kerf::compare
