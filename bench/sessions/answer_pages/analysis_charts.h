#pragma once

#include <vector>

#include "answers/analysis.h"
#include "plot/plot.h"

namespace kerf::bench {

/// What of an analysis is drawn, by name: "proportions", "psychometric", "roc", "track-1" ..., "ranking-1"
/// ..., "response-times"; those that the study has something for.
[[nodiscard]] std::vector<Figure> analysis_figures(const Study& study, const Analysis& analysis);

/// Shares with their intervals, one line a group, against chance.
[[nodiscard]] Chart proportion_chart(const Analysis& analysis);
/// Share right, or share that named the comparison, over level: points as large as they have answers.
[[nodiscard]] Chart psychometric_chart(const Analysis& analysis);
/// Level over trial, with what was right, and where a staircase turned.
[[nodiscard]] Chart track_chart(const AdaptiveTrack& track, const Analysis& analysis);
/// Worth of the samples of a tissue with intervals.
[[nodiscard]] Chart ranking_chart(const TissueRanking& ranking, const Analysis& analysis);
/// Medians and quartiles of all answers and of each subject, right and wrong ones apart.
[[nodiscard]] Chart time_chart(const Study& study, const Analysis& analysis);

}  // namespace kerf::bench
