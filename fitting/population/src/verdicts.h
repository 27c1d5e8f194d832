#pragma once

#include <vector>

#include <kerf/population/compare.h>

namespace kerf::population {

/// Refuses levels, confidences and draws that cannot be.
void require_options(const CompareOptions& options);

/// Corrects the tests of a study for each other and says what they mean.
void judge(std::vector<Comparison>& comparisons, double level);

/// Difference, interval and Hedges' g of differences within specimens.
void take_differences(std::span<const Estimate> differences, double confidence, Comparison& result);

/// 1 - 3 / (4 df - 1): Hedges' correction for few.
[[nodiscard]] double correction_for_few(double degrees_of_freedom);

}  // namespace kerf::population
