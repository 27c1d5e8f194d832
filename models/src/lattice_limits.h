#pragma once

#include "kerf/models/lattice.h"

namespace kerf::models {

/// Throws std::invalid_argument where an option is out of range.
void check(const LatticeOptions& options);

/// coupling_limit() of options and a step that have been checked.
[[nodiscard]] double coupling_limit_unchecked(const LatticeOptions& options, double dt,
                                              double damping) noexcept;

}  // namespace kerf::models
