#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <kerf/psychophysics/quest_plus.h>
#include <kerf/psychophysics/staircase.h>

#include "protocol/plan.h"

namespace kerf::bench {

/// What QUEST+ takes for granted of a scale: thresholds from a tenth to ten times the expected JND, equally
/// likely on a logarithmic axis; slopes and lapse rates as usual.
[[nodiscard]] psychophysics::QuestPlusOptions quest_options_of(const IntensityScale& scale, double guess);

/// How a session goes on from the answers so far: which trial is next, at which level. A value without clock
/// or chance, so that a session is resumed by giving it the recorded answers again.
class TrialSequence {
 public:
  /// @throws std::invalid_argument: an adaptive design whose scale cannot be.
  TrialSequence(Protocol protocol, Plan plan);

  /// The trial to be given now, its level filled in (of practice one that is easy to tell); nothing once the
  /// session is over.
  [[nodiscard]] std::optional<TrialPlan> next() const;
  /// Its answer, a slot. @throws std::invalid_argument: no such answer, or the session is over.
  void answer(std::size_t slot);
  /// Trials answered, practice included.
  [[nodiscard]] std::size_t answered() const noexcept { return answered_; }
  /// All trials; of an adaptive design the most that there may be.
  [[nodiscard]] std::size_t at_most() const noexcept { return plan_.size(); }
  /// A break is due before the next trial: after every so many answers that count.
  [[nodiscard]] bool break_due() const noexcept;

 private:
  Protocol protocol_;
  Plan plan_;
  std::size_t answered_ = 0;
  std::optional<psychophysics::Staircase> staircase_;
  std::optional<psychophysics::QuestPlus> quest_;
};

}  // namespace kerf::bench
