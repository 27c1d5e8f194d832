#include "subject/subject_group.h"

namespace kerf::bench {

void SubjectGroup::show(const SubjectView& view) {
  for (Subject* const subject : subjects_) subject->show(view);
}

std::optional<SubjectAction> SubjectGroup::next() {
  for (Subject* const subject : subjects_) {
    if (std::optional<SubjectAction> action = subject->next()) return action;
  }
  return std::nullopt;
}

}  // namespace kerf::bench
