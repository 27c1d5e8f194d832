#include "protocol/questionnaire/questionnaire_table.h"

#include <fmt/core.h>

#include "tables/csv.h"

namespace kerf::bench {

std::string questionnaire_csv(const Study& study) {
  std::string text = fmt::format(
      "# name = {}\n"
      "# score: from 0, the first of the item's ends, to {:g}; tissue: after whose trials, empty where it "
      "was "
      "asked at the end or tissues have no names; at: UTC, of the last item\n"
      "subject,number,tissue,item,score,at\n",
      csv_quoted(study.name), questionnaire_most);
  for (const QuestionnaireAnswers& each : study.questionnaires) {
    for (std::size_t item = 0; item < each.scores.size(); ++item)
      text += fmt::format("{},{},{},{},{},{}\n", csv_text(each.subject), each.session, csv_text(each.tissue),
                          csv_text(study.questionnaire.items.at(item).name), csv_number(each.scores[item]),
                          each.at);
  }
  return text;
}

}  // namespace kerf::bench
