#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <kerf/psychophysics/quest_plus.h>
#include <kerf/psychophysics/staircase.h>

#include "protocol/plan.h"

namespace kerf::bench {

/// What QUEST+ takes for granted of a scale: its grids, all points equally likely; where it gives no
/// thresholds they go from a tenth to ten times the expected JND on a logarithmic axis.
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
  /// Its answer, one of choices_of(); of a catch trial no rule learns of it. @throws std::invalid_argument:
  /// no such answer, or the session is over.
  void answer(std::size_t slot);
  /// The trial at hand is void: no rule learns of it. It comes again, with the same slots, at the end of its
  /// block; of an adaptive design at the end of its ten, within which the slots are even.
  /// @return false: it came again as often as the protocol permits, and is left out.
  /// @throws std::invalid_argument: the session is over.
  bool repeat();
  /// Trials given, practice and void ones included.
  [[nodiscard]] std::size_t answered() const noexcept { return answered_; }
  /// All trials, with those that came again or will; of an adaptive design the most that there may be.
  [[nodiscard]] std::size_t at_most() const noexcept { return order_.size(); }
  /// The same without repetitions.
  [[nodiscard]] std::size_t planned() const noexcept { return plan_.size() - skipped_; }
  /// Whether practice came to its criterion; nothing where there is none, or practice goes on.
  [[nodiscard]] std::optional<bool> practised() const noexcept { return practised_; }
  /// A break is due before the next trial: after every so many past practice.
  [[nodiscard]] bool break_due() const noexcept;

 private:
  void judge_practice();
  /// The staircase whose turn it is, or the next one after it that has not ended.
  [[nodiscard]] std::optional<std::size_t> track_at_turn(std::size_t planned) const;

  Protocol protocol_;
  Plan plan_;
  std::vector<std::size_t> block_;  ///< of each of the plan: practice, a tissue, or ten of an adaptive design
  std::vector<std::size_t> order_;  ///< of the plan, with repetitions
  std::size_t answered_ = 0;
  std::size_t skipped_ = 0;  ///< of the plan, by the criterion of practice
  std::vector<bool> practice_right_;
  std::optional<bool> practised_;
  std::vector<psychophysics::Staircase> staircases_;
  std::optional<psychophysics::QuestPlus> quest_;
};

}  // namespace kerf::bench
