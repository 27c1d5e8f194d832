#pragma once

#include <nlohmann/json.hpp>

#include "fits/asked_fit.h"

namespace kerf::bench {

/// What a page asks of a fit, by the names of the options of `kerf fit`, in SI:
///
///     axis, rows, cycles, contact [m or rad], direction, rate [Hz], noise [N or N·m]
///     segments, points_per_segment, breakpoints (a list of texts), arms, memberships, thickness,
///     option (a list of NAME=VALUE)
///     folds (0: none), test_share, loss, loss_scale, confidence, profile, weber, threshold
///
/// What is not there is as `kerf fit` has it; check() says what is out of its range.
/// @throws RequestError 400 for a value of another kind, and for a name that is none of these, `recording` or
/// `models`.
[[nodiscard]] AskedFit asked_fit_in(const nlohmann::json& given);

}  // namespace kerf::bench
