#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/repeated_measures.h>

#include "protocol/judgement.h"

namespace kerf::bench {

/// What people answered to one item after one tissue; each counts once, by the mean of its answers.
struct QuestionnaireScore {
  std::string tissue;
  std::string item;  ///< "overall": the mean of all items, of NASA's Task Load Index the raw TLX
  std::size_t subjects = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();    ///< from 0 to 100
  std::optional<psychophysics::SubjectsMean> over_subjects;  ///< of two subjects and more
};

/// By tissues in order of appearance, items in theirs, then overall. @throws std::invalid_argument.
[[nodiscard]] std::vector<QuestionnaireScore> questionnaire_scores(const Study& study, double confidence);

}  // namespace kerf::bench
