#pragma once

#include <kerf/models/foreign.h>

#include "kernels/law_kernel.h"

namespace kerf::fitting {

/// The kernel of a plug-in's law. Derivatives are the plug-in's own where it has them; else differences of
/// states that are carried side by side, two a searched parameter.
[[nodiscard]] const LawKernel& kernel_of(const models::ForeignLaw& law);

}  // namespace kerf::fitting
