#pragma once

#include <cstddef>
#include <vector>

#include <kerf/population/compare.h>

namespace kerf::population {

/// Values of which any `first` may be the first group's, and the others the second's.
struct Block {
  std::vector<double> values;  ///< those of the first group come first, as they were recorded
  std::size_t first = 0;
};

/// Exchanges one block between the groups: Welch's t, or where a group has one value the difference of means.
[[nodiscard]] PermutationTest permute_units(const Block& units, Exchange exchange,
                                            const CompareOptions& options);

/// Exchanges within blocks: t of the differences of means, over blocks.
[[nodiscard]] PermutationTest permute_within(const std::vector<Block>& blocks, Exchange exchange,
                                             const CompareOptions& options);

}  // namespace kerf::population
