#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/comparisons.h>

#include "protocol/judgement.h"

namespace kerf::bench {

struct AnalysisOptions;

/// Two samples of a ranking.
struct RankedPair {
  std::size_t first = 0;  ///< of the ranking's samples
  std::size_t second = 0;
  psychophysics::Difference difference;  ///< of worth, first less second, Bradley-Terry
  double p_adjusted = 1.0;               ///< over all pairs of the tissue
};

/// The samples of a tissue on one scale, where there are more than two.
struct TissueRanking {
  std::string tissue;
  std::vector<std::size_t> samples;  ///< of the study
  psychophysics::Wins wins;
  std::optional<psychophysics::Ranking> bradley_terry;
  std::optional<psychophysics::Ranking> thurstone;
  std::vector<psychophysics::Interval> intervals;  ///< of the worth by Bradley-Terry, normal
  std::vector<RankedPair> pairs;
  std::string note;  ///< why there is no scale
};

/// One a tissue whose answers name more than two samples.
[[nodiscard]] std::vector<TissueRanking> rank_tissues(const Study& study,
                                                      const std::vector<const Judgement*>& judgements,
                                                      const AnalysisOptions& options);

}  // namespace kerf::bench
