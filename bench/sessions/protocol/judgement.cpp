#include "protocol/judgement.h"

namespace kerf::bench {

Study study_of(const Protocol& protocol) {
  Study study{.name = protocol.name, .design = protocol.design, .scale = protocol.scale, .judgements = {}};
  for (const SessionSample& sample : protocol.samples) study.samples.push_back(sample.name);
  const bool some_answer_is_right = protocol.design != Design::preference &&
                                    !(protocol.design == Design::constant && protocol.scale.two_sided());
  if (some_answer_is_right) study.task = task_of(protocol);
  return study;
}

}  // namespace kerf::bench
