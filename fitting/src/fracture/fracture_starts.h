#pragma once

#include <cstddef>
#include <vector>

#include "fracture/fracture_cells.h"

namespace kerf::fitting {

/// How closely depths and cracks are looked at, and how many places are gone on from.
struct FractureGrid {
  int depths;
  int cracks;  ///< for each depth, from there to the largest penetration, besides one that ends at the tool
  std::size_t kept;
};

/// Places to go on from: of depths and cracks all over the tool's path, amplitude and exponent at their best,
/// those that leave least, each beyond the neighbours of the ones before. The best comes first.
[[nodiscard]] std::vector<FracturePlace> fracture_starts(const FractureObjective& objective, double most_m,
                                                         const FractureGrid& grid);

}  // namespace kerf::fitting
