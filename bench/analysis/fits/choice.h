#pragma once

#include <span>
#include <vector>

#include <kerf/fitting/fit.h>

namespace kerf::bench {

/// The force JND at the root mean square of the forces [N].
[[nodiscard]] double jnd_of(std::span<const double> force, const fitting::ForceJnd& jnd);

/// The simplest law by its error on held-out data: cycles or blocks of the cross-validation, else the share
/// that was kept back for a test. Where there is neither, the law with the least BIC.
[[nodiscard]] fitting::Choice choose(std::span<const fitting::FitResult> results,
                                     const fitting::Series& series, const fitting::FitOptions& options);

}  // namespace kerf::bench
