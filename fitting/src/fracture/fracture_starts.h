#pragma once

#include <cstddef>
#include <vector>

#include "fracture/fracture_cells.h"
#include "samples.h"

namespace kerf::fitting {

/// How closely depths and cracks are looked at, and how many places are gone on from.
struct FractureGrid {
  int depths;
  int cracks;  ///< for each depth, from there to the largest penetration, besides one that ends at the tool
  std::size_t kept;
};

/// Depths between the two rows over which the force falls most while the tool goes in, the largest fall
/// first: where a tissue may have yielded. A grid of depths passes over what lies between two rows.
[[nodiscard]] std::vector<double> depths_of_falls(const Samples& samples, const Weights& weights);

/// Places to go on from: of depths and cracks all over the tool's path and of depths beside (`falls`),
/// amplitude and exponent at their best, those that leave least, each beyond the neighbours of the ones
/// before. The best comes first.
[[nodiscard]] std::vector<FracturePlace> fracture_starts(const FractureObjective& objective, double most_m,
                                                         const FractureGrid& grid,
                                                         const std::vector<double>& falls);

}  // namespace kerf::fitting
