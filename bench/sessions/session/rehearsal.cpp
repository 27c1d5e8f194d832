#include "session/rehearsal.h"

namespace kerf::bench {

void RehearsalSubject::show(const SubjectView& view) {
  if (view.trial != view_.trial || view.stage != view_.stage) {
    slot_ = 0;
    tries_ = 0;
  }
  view_ = view;
}

std::optional<SubjectAction> RehearsalSubject::next() {
  using Kind = SubjectAction::Kind;
  if (view_.may_go_on) return tried({.kind = Kind::go_on});
  if (view_.may_switch && slot_ < view_.labels.size()) {
    if (++polls_ < ticks_a_slot && slot_ > 0) return std::nullopt;
    polls_ = 0;
    return SubjectAction{.kind = Kind::play, .slot = slot_++};
  }
  if (!view_.may_answer) return std::nullopt;
  return tried({.kind = Kind::answer, .slot = random_.below(view_.answers)});
}

SubjectAction RehearsalSubject::tried(const SubjectAction& action) {
  return ++tries_ > most_tries ? SubjectAction{.kind = SubjectAction::Kind::quit} : action;
}

}  // namespace kerf::bench
