#include "protocol/judgement.h"

#include <algorithm>

namespace kerf::bench {

std::vector<SubjectCatches> catches_by_subject(const Study& study) {
  std::vector<SubjectCatches> all;
  for (const Judgement& each : study.judgements) {
    if (!each.is_catch || !each.void_reasons.empty()) continue;
    auto own = std::ranges::find(all, each.subject, &SubjectCatches::subject);
    if (own == all.end()) own = all.insert(all.end(), SubjectCatches{.subject = each.subject, .tally = {}});
    ++own->tally.trials;
    own->tally.right += each.is_right() ? 1 : 0;
  }
  return all;
}

Study study_of(const Protocol& protocol) {
  Study study{.name = protocol.name, .design = protocol.design, .scale = protocol.scale, .judgements = {}};
  for (const SessionSample& sample : protocol.samples) study.samples.push_back(sample.name);
  study.confidence_levels = protocol.confidence.size();
  study.numbers = protocol.numbers;
  study.questionnaire = protocol.questionnaire;
  const bool some_answer_is_right = protocol.design != Design::preference && !asks_numbers(protocol.design) &&
                                    !(protocol.design == Design::constant && protocol.scale.two_sided());
  if (some_answer_is_right) study.task = task_of(protocol);
  return study;
}

}  // namespace kerf::bench
