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
  psychophysics::Difference
      difference;           ///< of worth, first less second, Bradley-Terry; errors as `intervals`
  double p_adjusted = 1.0;  ///< over all pairs of the tissue
};

/// The samples of a tissue on one scale, where there are more than two.
struct TissueRanking {
  std::string tissue;
  std::vector<std::size_t> samples;  ///< of the study
  psychophysics::Wins wins;
  std::optional<psychophysics::Ranking> bradley_terry;
  std::optional<psychophysics::Ranking> thurstone;
  std::optional<psychophysics::SubjectsRanking>
      over_subjects;            ///< with bradley_terry, of two subjects and more
  bool tests_subjects = false;  ///< there are enough of them for over_subjects to reach the level
  /// Of the worth by Bradley-Terry: Student's over subjects where `tests_subjects`, else normal over answers.
  std::vector<psychophysics::Interval> intervals;
  std::vector<RankedPair> pairs;
  std::string note;  ///< why there is no scale

  /// That all are equal; with bradley_terry.
  [[nodiscard]] double p_value() const { return tests_subjects ? over_subjects->p : bradley_terry->ratio_p; }
  [[nodiscard]] double error_of(std::size_t sample) const;  ///< of its worth, as `intervals`
};

/// One a tissue whose answers name more than two samples.
[[nodiscard]] std::vector<TissueRanking> rank_tissues(const Study& study,
                                                      const std::vector<const Judgement*>& judgements,
                                                      const AnalysisOptions& options);

}  // namespace kerf::bench
