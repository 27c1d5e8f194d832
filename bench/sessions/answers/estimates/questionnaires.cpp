#include "answers/estimates/questionnaires.h"

#include <algorithm>
#include <map>

namespace kerf::bench {
namespace {

double mean_of_scores(const std::vector<double>& scores) {
  double sum = 0.0;
  for (const double score : scores) sum += score;
  return sum / static_cast<double>(scores.size());
}

}  // namespace

std::vector<QuestionnaireScore> questionnaire_scores(const Study& study, double confidence) {
  std::vector<std::string> tissues;
  for (const QuestionnaireAnswers& each : study.questionnaires) {
    if (std::ranges::find(tissues, each.tissue) == tissues.end()) tissues.push_back(each.tissue);
  }
  std::vector<QuestionnaireScore> scores;
  for (const std::string& tissue : tissues) {
    for (std::size_t item = 0; item <= study.questionnaire.items.size(); ++item) {
      const bool is_overall = item == study.questionnaire.items.size();
      std::map<std::string, std::vector<double>> by_subject;
      for (const QuestionnaireAnswers& each : study.questionnaires) {
        if (each.tissue == tissue)
          by_subject[each.subject].push_back(is_overall ? mean_of_scores(each.scores) : each.scores.at(item));
      }
      std::vector<double> means;
      for (const auto& [subject, own] : by_subject) means.push_back(mean_of_scores(own));
      QuestionnaireScore& score = scores.emplace_back(
          QuestionnaireScore{.tissue = tissue,
                             .item = is_overall ? "overall" : study.questionnaire.items[item].name,
                             .subjects = means.size(),
                             .mean = mean_of_scores(means)});
      if (means.size() > 1) score.over_subjects = psychophysics::subjects_mean(means, confidence);
    }
  }
  return scores;
}

}  // namespace kerf::bench
