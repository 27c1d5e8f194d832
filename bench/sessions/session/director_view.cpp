#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "session/director.h"

namespace kerf::bench {

void Director::view_of_trial(SubjectView& view) const {
  const Protocol& protocol = store_.protocol();
  view.stage = SessionStage::trial;
  view.text = protocol.question;
  view.practice = planned_.practice;
  for (std::size_t slot = 0; slot < slots_; ++slot) view.labels.emplace_back(label_of(protocol.design, slot));
  view.answers = answers_of(protocol.design);
  view.playing = playing_;
  if (phase_ == Phase::unstored) view.may_answer = true;
  if (phase_ != Phase::trial) return;
  view.may_switch = protocol.presentation == Presentation::free && !time_is_over();
  view.may_answer = may_answer();
}

SubjectView Director::view() const {
  const Protocol& protocol = store_.protocol();
  SubjectView view{.study = protocol.title,
                   .trial = std::min(sequence_.answered() + 1, sequence_.at_most()),
                   .at_most = sequence_.at_most(),
                   .may_be_fewer = is_adaptive(protocol.design),
                   .notice = notice_};
  switch (phase_) {
    case Phase::welcome:
      view.stage = SessionStage::welcome;
      if (sequence_.answered() > 0)
        view.text = fmt::format("The session goes on: {} trials are done.", sequence_.answered());
      view.may_go_on = true;
      break;
    case Phase::consent:
      view.stage = SessionStage::consent;
      view.text = protocol.consent;
      view.may_go_on = true;
      break;
    case Phase::instructions:
      view.stage = SessionStage::instructions;
      view.text = protocol.instructions;
      view.may_go_on = true;
      break;
    case Phase::trial:
    case Phase::fading:
    case Phase::unstored:
      view_of_trial(view);
      break;
    case Phase::feedback: {
      const std::size_t right = planned_.right(protocol);
      view.stage = SessionStage::feedback;
      view.text = fmt::format("{} It was {}.", answer_ == right ? "Right." : "Not right.",
                              label_of(protocol.design, right));
      view.trial = sequence_.answered();
      view.practice = true;
      view.may_go_on = true;
      break;
    }
    case Phase::pause:
      view.stage = SessionStage::pause;
      view.wait_s = std::max(0.0, std::ceil(protocol.break_s - (now_s_ - since_s_)));
      view.may_go_on = view.wait_s == 0.0;
      break;
    case Phase::leaving:
    case Phase::over:
      view.stage = SessionStage::finished;
      view.text = end_ == SessionEnd::finished ? "That was the last trial. Thank you."
                                               : "The session stops here for now. Thank you.";
      break;
  }
  return view;
}

}  // namespace kerf::bench
