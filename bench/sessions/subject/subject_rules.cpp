#include "subject/subject_rules.h"

namespace kerf::bench {

bool permits(const SubjectView& view, const SubjectAction& action) noexcept {
  using Action = SubjectAction::Kind;
  switch (action.kind) {
    case Action::go_on:
      return view.may_go_on;
    case Action::decline:
      return view.stage == SessionStage::consent;
    case Action::play:
      return view.may_switch && action.slot < view.labels.size();
    case Action::answer:
      if (view.number) return view.may_answer && view.number->takes(action.number);
      return view.may_answer && action.slot < view.answers;
    case Action::quit:
      return true;
    case Action::slip:
      return view.may_slip;
  }
  return false;
}

}  // namespace kerf::bench
