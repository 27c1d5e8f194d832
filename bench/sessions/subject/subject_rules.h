#pragma once

#include "subject/subject.h"

namespace kerf::bench {

/// Another screen, for which nothing is meant that was asked for on the one before.
[[nodiscard]] inline bool is_new_screen(const SubjectView& before, const SubjectView& now) noexcept {
  return before.stage != now.stage || before.trial != now.trial;
}

/// The view permits it.
[[nodiscard]] bool permits(const SubjectView& view, const SubjectAction& action) noexcept;

/// Whether a label means "let me feel it" in the trial at hand, or "this is my answer". Once the subject
/// could switch it stays the former to the end of the trial, so that nobody who goes on feeling after its
/// time answers by mistake.
class TrialManner {
 public:
  void see(const SubjectView& before, const SubjectView& now) noexcept {
    if (is_new_screen(before, now)) free_ = false;
    free_ = free_ || (now.stage == SessionStage::trial && now.may_switch);
  }
  [[nodiscard]] bool is_free() const noexcept { return free_; }

 private:
  bool free_ = false;
};

}  // namespace kerf::bench
