#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "subject/subject.h"

namespace kerf::bench {

/// Several ways at once to see and to act: all show the view, and the first action wins. The others are asked
/// again only after the session has dealt with it, and forget what was meant for the screen before.
class SubjectGroup final : public Subject {
 public:
  /// They have to outlive the group.
  explicit SubjectGroup(std::vector<Subject*> subjects) : subjects_(std::move(subjects)) {}

  void show(const SubjectView& view) override;
  [[nodiscard]] std::optional<SubjectAction> next() override;

 private:
  std::vector<Subject*> subjects_;
};

}  // namespace kerf::bench
