#pragma once

#include <span>

#include <kerf/psychophysics/psychometric_fit.h>

namespace kerf::bench {

/// A curve from "less" to "more" whose lapses are alike at both ends: guess = lapse, one of 0, 2, 4 and 6 %
/// by the largest likelihood (or `options.lapse`, fixed). psi is 50 % at the threshold.
///
/// The intervals are those of the profile over the lapses too: of each lapse rate what lies within the loss
/// of log-likelihood that the best one leaves it, all together. Taken at the best rate alone they cover 84 to
/// 90 % where they say 95; together 92 to 96 % (seven levels of 20 and of 50 trials, lapses of 0, 2 and 4 %,
/// 300 experiments each). A lapse rate that is held at 0 while it is 4 % makes the JND 30 % too large.
[[nodiscard]] psychophysics::PsychometricFit fit_with_equal_lapses(
    std::span<const psychophysics::Level> levels, const psychophysics::FitOptions& options);

}  // namespace kerf::bench
