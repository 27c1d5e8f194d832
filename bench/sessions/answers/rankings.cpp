#include "answers/rankings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <kerf/psychophysics/equivalence.h>

#include "answers/analysis.h"

namespace kerf::bench {
namespace {

std::size_t place_of(std::vector<std::size_t>& samples, std::size_t sample) {
  const auto found = std::find(samples.begin(), samples.end(), sample);
  if (found == samples.end()) samples.push_back(sample);
  return static_cast<std::size_t>(std::find(samples.begin(), samples.end(), sample) - samples.begin());
}

struct GatheredRanking {
  TissueRanking ranking;
  std::vector<psychophysics::Wins> by_subject;
};

GatheredRanking gathered(const std::string& tissue, const std::vector<const Judgement*>& judgements) {
  TissueRanking ranking;
  ranking.tissue = tissue;
  for (const Judgement* judgement : judgements) {
    if (judgement->tissue != tissue) continue;
    for (const std::size_t sample : judgement->pair) (void)place_of(ranking.samples, sample);
  }
  std::sort(ranking.samples.begin(), ranking.samples.end());
  ranking.wins.assign(ranking.samples.size(), std::vector<int>(ranking.samples.size(), 0));
  std::map<std::string, psychophysics::Wins> by_subject;
  for (const Judgement* judgement : judgements) {
    if (judgement->tissue != tissue) continue;
    const bool second = judgement->is_right();
    const std::size_t winner = place_of(ranking.samples, judgement->pair[second ? 1 : 0]);
    const std::size_t loser = place_of(ranking.samples, judgement->pair[second ? 0 : 1]);
    ++ranking.wins[winner][loser];
    auto [own, is_new] = by_subject.try_emplace(judgement->subject);
    if (is_new) own->second.assign(ranking.samples.size(), std::vector<int>(ranking.samples.size(), 0));
    ++own->second[winner][loser];
  }
  GatheredRanking result{.ranking = std::move(ranking), .by_subject = {}};
  for (auto& [subject, wins] : by_subject) result.by_subject.push_back(std::move(wins));
  return result;
}

void add_over_subjects(TissueRanking& ranking, const std::vector<psychophysics::Wins>& by_subject,
                       const AnalysisOptions& options) {
  if (by_subject.size() < 2) return;
  try {
    ranking.over_subjects = psychophysics::rank_over_subjects(by_subject, {.seed = options.seed});
  } catch (const std::invalid_argument& refused) {
    ranking.note = refused.what();
    return;
  }
  ranking.tests_subjects = ranking.over_subjects->least_p <= options.whole_level();
}

void put_on_scale(TissueRanking& ranking, const std::vector<psychophysics::Wins>& by_subject,
                  const AnalysisOptions& options) {
  try {
    ranking.bradley_terry = psychophysics::rank(ranking.wins);
    ranking.thurstone = psychophysics::rank(ranking.wins, psychophysics::Scale::thurstone);
  } catch (const std::invalid_argument& refused) {
    ranking.note = refused.what();
    return;
  }
  add_over_subjects(ranking, by_subject, options);
  for (std::size_t i = 0; i < ranking.samples.size(); ++i) {
    const psychophysics::Estimate estimate{
        .value = ranking.bradley_terry->worth[i],
        .standard_error = ranking.error_of(i),
        .degrees_of_freedom = ranking.tests_subjects ? static_cast<double>(by_subject.size()) - 1.0 : 0.0};
    ranking.intervals.push_back(psychophysics::equivalent_estimate(estimate, {.lower = -1.0, .upper = 1.0},
                                                                   0.5 * (1.0 - options.confidence))
                                    .interval);
  }
  std::vector<double> p;
  for (std::size_t i = 0; i < ranking.samples.size(); ++i) {
    for (std::size_t j = i + 1; j < ranking.samples.size(); ++j) {
      ranking.pairs.push_back({.first = i,
                               .second = j,
                               .difference = ranking.tests_subjects
                                                 ? psychophysics::difference(*ranking.over_subjects, i, j)
                                                 : psychophysics::difference(*ranking.bradley_terry, i, j)});
      p.push_back(ranking.pairs.back().difference.p);
    }
  }
  const auto adjusted = options.correction == FamilyCorrection::holm ? psychophysics::holm(p)
                                                                     : psychophysics::benjamini_hochberg(p);
  for (std::size_t i = 0; i < p.size(); ++i) ranking.pairs[i].p_adjusted = adjusted[i];
}

}  // namespace

double TissueRanking::error_of(std::size_t sample) const {
  return tests_subjects ? std::sqrt(over_subjects->covariance[sample][sample])
                        : bradley_terry->standard_error[sample];
}

std::vector<TissueRanking> rank_tissues(const Study& study, const std::vector<const Judgement*>& judgements,
                                        const AnalysisOptions& options) {
  std::vector<TissueRanking> rankings;
  if (study.design != Design::preference) return rankings;
  std::vector<std::string> tissues;
  for (const Judgement* judgement : judgements) {
    if (std::find(tissues.begin(), tissues.end(), judgement->tissue) == tissues.end())
      tissues.push_back(judgement->tissue);
  }
  for (const std::string& tissue : tissues) {
    auto [ranking, by_subject] = gathered(tissue, judgements);
    if (ranking.samples.size() < 3) continue;
    put_on_scale(ranking, by_subject, options);
    rankings.push_back(std::move(ranking));
  }
  return rankings;
}

}  // namespace kerf::bench
