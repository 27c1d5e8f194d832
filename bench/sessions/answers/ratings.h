#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/detection/rating_roc.h>
#include <kerf/psychophysics/sign_flips.h>

#include "protocol/judgement.h"

namespace kerf::bench {

struct AnalysisOptions;

/// How sure yes and no were, of a subject or of all: the ROC curve.
struct RatingGroup {
  std::string name;
  psychophysics::Ratings ratings;  ///< from the surest "no" to the surest "yes"
  std::optional<psychophysics::RocArea> area;
  std::optional<psychophysics::NormalRoc> fit;  ///< with a variance of the signal of its own
  std::optional<double> equal_variances_p;      ///< by the likelihood ratio, chi-squared of one degree
  std::string note;                             ///< why something is missing
};

struct RatingAnalysis {
  RatingGroup all;  ///< pooled: criteria that differ between subjects flatten its curve
  std::vector<RatingGroup> by_subject;
  /// Of the subjects' areas less 1/2, each counting once; none of one subject.
  std::optional<psychophysics::SignFlips> over_subjects;
};

/// What somebody does who says "yes" from one category on.
struct RocPoint {
  double false_alarm_rate = 0.0;
  double hit_rate = 0.0;
};

/// One for each criterion between two categories, from the strictest, which takes the surest "yes" alone;
/// without the corners. None without trials of both kinds.
[[nodiscard]] std::vector<RocPoint> roc_points(const psychophysics::Ratings& ratings);

/// None where confidence was not asked.
[[nodiscard]] std::optional<RatingAnalysis> analyse_ratings(const Study& study,
                                                            const std::vector<const Judgement*>& judgements,
                                                            const AnalysisOptions& options);

}  // namespace kerf::bench
