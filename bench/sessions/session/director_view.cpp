#include <algorithm>
#include <cmath>
#include <string>

#include "session/director.h"

namespace kerf::bench {

bool Director::shows_guide() const {
  if (phase_ == Phase::ready) return is_led(sequence_.next()->practice);
  return phase_ == Phase::trial && is_led(planned_.practice) && !time_is_over() &&
         (store_.protocol().presentation == Presentation::free || intervals_begun_ <= slots_);
}

void Director::view_of_trial(SubjectView& view) const {
  const Protocol& protocol = store_.protocol();
  view.stage = SessionStage::trial;
  view.text = protocol.question;
  if (protocol.numbers.standard)
    view.text += " " + (*protocol.texts)("question_of_second",
                                         {{"modulus", fmt::format("{:g}", protocol.numbers.modulus)}});
  view.practice = planned_.practice;
  for (std::size_t slot = 0; slot < slots_; ++slot) view.labels.emplace_back(label_of(protocol.design, slot));
  view.answers = choices_of(protocol);
  view.answer_labels = choice_labels_of(protocol);
  view.in_steps = protocol.numbers.points > 0;
  if (const std::optional<NumberRange> range = written_numbers_of(protocol)) {
    view.number = {.lower = range->lower, .upper = range->upper, .step = 0.0, .ends = {}};
    if (protocol.design == Design::rating)
      view.number->ends.assign(protocol.numbers.ends.begin(), protocol.numbers.ends.end());
  }
  view.playing = playing_;
  view.guided = shows_guide();
  if (phase_ == Phase::unstored) (answer_ == no_answer ? view.may_slip : view.may_answer) = true;
  if (phase_ != Phase::trial) return;
  view.may_switch = protocol.presentation == Presentation::free && !time_is_over();
  view.may_answer = may_answer();
  view.may_slip = may_slip();
}

SubjectView Director::view() const {
  const Protocol& protocol = store_.protocol();
  const std::size_t trial = std::min(sequence_.answered() + 1, sequence_.at_most());
  const SubjectTexts& texts = *protocol.texts;
  SubjectView view{.study = protocol.title,
                   .trial = trial,
                   // How many come again may hang on what was played, so it is not told ahead.
                   .at_most = std::max(sequence_.planned(), trial),
                   .may_be_fewer = is_adaptive(protocol.design),
                   .may_be_more = protocol.rules.may_void(),
                   .notice = notice_,
                   .texts = protocol.texts};
  switch (phase_) {
    case Phase::welcome:
      view.stage = SessionStage::welcome;
      if (const std::size_t done = sequence_.answered(); done > 0)
        view.text = texts(done == 1 ? TextName("goes_on_one") : TextName("goes_on_other"),
                          {{"trials", std::to_string(done)}});
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
    case Phase::ready: {
      const TrialRules& rules = protocol.rules;
      const bool waits = now_s_ - since_s_ < rules.pause_s;
      view.stage = SessionStage::ready;
      view.may_go_on = !waits && rules.start == TrialStart::key;
      view.tool_is_waited_for = !waits && rules.start == TrialStart::out_of_contact;
      view.practice = sequence_.next()->practice;
      view.guided = shows_guide();
      if (cycle_waited_in_) view.may_go_on = view.tool_is_waited_for = false;
      break;
    }
    case Phase::trial:
    case Phase::fading:
    case Phase::unstored:
      view_of_trial(view);
      break;
    case Phase::feedback: {
      const std::size_t right = planned_.right(protocol);
      view.stage = SessionStage::feedback;
      const bool is_right = answer_of_choice(protocol, answer_) == right;
      view.text = texts(is_right ? TextName("feedback_right") : TextName("feedback_wrong"),
                        {{"answer", told_answer(protocol, right)}});
      view.trial = sequence_.answered();
      view.practice = true;
      view.may_go_on = true;
      break;
    }
    case Phase::questionnaire: {
      const QuestionnaireItem& item = protocol.questionnaire.items[scores_.size()];
      view.stage = SessionStage::questionnaire;
      view.text = item.question;
      view.number = {.lower = 0.0,
                     .upper = questionnaire_most,
                     .step = questionnaire_step,
                     .ends = {item.ends[0], item.ends[1]}};
      view.trial = scores_.size() + 1;
      view.at_most = protocol.questionnaire.items.size();
      view.may_answer = true;
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
      view.text = end_ == SessionEnd::finished ? texts("finished_last") : texts("finished_for_now");
      break;
  }
  return view;
}

}  // namespace kerf::bench
