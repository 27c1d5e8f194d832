#pragma once

#include "answers/ratings.h"
#include "plot/plot.h"

namespace kerf::bench {

/// Hit rate over false-alarm rate at each criterion of confidence: points of all answers, those of each
/// subject behind them, the curve of the normal distributions where one was fitted,
///
///     F(c) = P(-c),   H(c) = P((mean - c) / deviation),
///
/// and the diagonal of who guesses. The legend has the area with its interval. Needs `analysis.all.area`.
[[nodiscard]] Chart roc_chart(const RatingAnalysis& analysis, double confidence);

}  // namespace kerf::bench
