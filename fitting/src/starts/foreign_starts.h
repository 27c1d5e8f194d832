#pragma once

#include <vector>

#include <kerf/models/foreign.h>

#include "starts/scan.h"

namespace kerf::fitting {

/// Where the search of a plug-in's law begins. What its plug-in says to be linear is solved for; the others
/// take their initial values, then those of a sequence that fills the space around them evenly: three decades
/// to either side on a logarithmic scale, ten times the value on a linear one, within the bounds.
[[nodiscard]] std::vector<LinearFamily> foreign_families(const Problem& problem,
                                                         const models::ForeignLaw& law);

}  // namespace kerf::fitting
