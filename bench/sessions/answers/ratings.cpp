#include "answers/ratings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "answers/analysis.h"

namespace kerf::bench {
namespace {

using Answers = std::vector<const Judgement*>;

psychophysics::Ratings ratings_of(std::size_t levels, const Answers& judgements) {
  psychophysics::Ratings ratings{.noise = std::vector<int>(2 * levels),
                                 .signal = std::vector<int>(2 * levels)};
  for (const Judgement* judgement : judgements) {
    if (judgement->confidence == 0 || judgement->confidence > levels) {
      throw std::invalid_argument(
          fmt::format("an answer of subject {} has the confidence {}, expected 1 to {}", judgement->subject,
                      judgement->confidence, levels));
    }
    const std::size_t category =
        judgement->answer == 1 ? levels + judgement->confidence - 1 : levels - judgement->confidence;
    ++(judgement->right == 1 ? ratings.signal : ratings.noise)[category];
  }
  return ratings;
}

RatingGroup group_of(std::string name, std::size_t levels, const Answers& judgements,
                     const AnalysisOptions& options) {
  RatingGroup group{.name = std::move(name), .ratings = ratings_of(levels, judgements)};
  try {
    group.area = psychophysics::roc_area(group.ratings, options.confidence);
    group.fit = psychophysics::fit_normal_roc(group.ratings, false, options.confidence);
    const auto equal = psychophysics::fit_normal_roc(group.ratings, true, options.confidence);
    group.equal_variances_p = psychophysics::equal_variances_p(*group.fit, equal);
  } catch (const std::invalid_argument& refused) {
    group.note = refused.what();
  }
  return group;
}

}  // namespace

std::vector<RocPoint> roc_points(const psychophysics::Ratings& ratings) {
  const auto total = [](const std::vector<int>& counts) {
    return std::accumulate(counts.begin(), counts.end(), 0);
  };
  const int noise = total(ratings.noise);
  const int signal = total(ratings.signal);
  std::vector<RocPoint> points;
  if (noise == 0 || signal == 0) return points;
  int false_alarms = 0;
  int hits = 0;
  for (std::size_t category = ratings.noise.size(); category-- > 1;) {
    false_alarms += ratings.noise[category];
    hits += ratings.signal[category];
    points.push_back({.false_alarm_rate = static_cast<double>(false_alarms) / noise,
                      .hit_rate = static_cast<double>(hits) / signal});
  }
  return points;
}

std::optional<RatingAnalysis> analyse_ratings(const Study& study, const Answers& judgements,
                                              const AnalysisOptions& options) {
  if (study.confidence_levels == 0 || judgements.empty()) return std::nullopt;
  RatingAnalysis analysis{.all = group_of("all", study.confidence_levels, judgements, options)};
  std::vector<std::string> subjects;
  for (const Judgement* judgement : judgements) {
    if (std::find(subjects.begin(), subjects.end(), judgement->subject) == subjects.end())
      subjects.push_back(judgement->subject);
  }
  if (subjects.size() < 2) return analysis;
  std::vector<double> beyond;
  for (const std::string& subject : subjects) {
    Answers own;
    std::copy_if(judgements.begin(), judgements.end(), std::back_inserter(own),
                 [&](const Judgement* judgement) { return judgement->subject == subject; });
    analysis.by_subject.push_back(group_of(subject, study.confidence_levels, own, options));
    if (analysis.by_subject.back().area) beyond.push_back(analysis.by_subject.back().area->value - 0.5);
  }
  if (!beyond.empty()) analysis.over_subjects = psychophysics::flip_signs(beyond, {.seed = options.seed});
  return analysis;
}

}  // namespace kerf::bench
