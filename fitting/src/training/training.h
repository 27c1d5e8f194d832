#pragma once

#include <string_view>
#include <vector>

#include "starts/search.h"

namespace kerf::fitting {

class TrainedMemory;

/// A law as it was found by the samples that it was shown.
struct Trained {
  Problem problem;
  Solution solution;  ///< no values: nowhere
  Weights weights;    ///< of the samples shown, each run by its noise
  RobustLoss loss;
  double correlation_time = 1.0;  ///< of the residuals of the samples shown, in samples
};

/// Tolerances of a search: of a law, and where only an error is asked for.
inline constexpr double of_a_law = 1e-12;
inline constexpr double of_a_fold = 1e-8;

/// Finds a law by the samples of positive weight alone. Whatever the data decide is decided by these: the
/// start, the weight of each run, the scale of a robust loss, the number of segments, the number of arms.
/// Only the range of the motion is taken from all samples, so that a law is defined where it is judged; and
/// of a law that is searched by descent, from where that of all samples ended (kept in `memory`) the search
/// goes on where that leaves less of those shown than it has found, or no more than they can tell apart.
/// Laws that were trained on the way are kept in `memory`, that of one fit; none: nothing is kept.
/// @throws std::invalid_argument where there are no more samples than parameters.
[[nodiscard]] Trained train(std::string_view model, const FitOptions& options, const Samples& samples,
                            Weights seen, double function_tolerance = of_a_law,
                            TrainedMemory* memory = nullptr);

/// What a law leaves of the force of each sample as a loop renders it; nothing where nothing renders it.
[[nodiscard]] std::vector<double> rendered_residuals(const Problem& problem, const Values& values,
                                                     const Samples& samples,
                                                     const decltype(FitOptions::render)& render);

/// What a law leaves of the force of each sample.
[[nodiscard]] std::vector<double> residuals_of(const Problem& problem, const Values& values,
                                               const Samples& samples);

}  // namespace kerf::fitting
