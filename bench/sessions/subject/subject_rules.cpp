#include "subject/subject_rules.h"

namespace kerf::bench {

bool permits(const SubjectView& view, const SubjectAction& action) noexcept {
  using Kind = SubjectAction::Kind;
  switch (action.kind) {
    case Kind::go_on:
      return view.may_go_on;
    case Kind::decline:
      return view.stage == SessionStage::consent;
    case Kind::play:
      return view.may_switch && action.slot < view.labels.size();
    case Kind::answer:
      return view.may_answer && action.slot < view.answers;
    case Kind::quit:
      return true;
  }
  return false;
}

}  // namespace kerf::bench
