#pragma once

#include "starts/search.h"

namespace kerf::fitting {

/// Sets how a piecewise law is searched, and its number of segments where the options leave it to the data:
/// by the samples of positive weight.
void prepare_segments(Problem& problem, const FitOptions& options, const Samples& samples,
                      const Weights& seen);

/// The outer knots are the ends of the data and not searched; given breakpoints hold the inner ones too.
void hold_knots(Problem& problem, bool all);

/// The best piecewise law of the problem's number of segments, globally on a grid and polished (segmented.h).
[[nodiscard]] Solution solve_segments(const Problem& problem, const Samples& samples, const Weights& weights,
                                      const RobustLoss& loss);

/// For each sample its branch, as the law itself decides it: 0 closing, 1 opening; all 0 without a loop.
[[nodiscard]] std::vector<std::uint8_t> branches(const Samples& samples, bool loop);

}  // namespace kerf::fitting
