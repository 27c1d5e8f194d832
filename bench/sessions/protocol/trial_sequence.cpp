#include "protocol/trial_sequence.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {

psychophysics::QuestPlusOptions quest_options_of(const IntensityScale& scale, double guess) {
  return {
      .shape = scale.shape,
      .guess = guess,
      .intensities = scale.levels,
      .thresholds = psychophysics::geometric_grid(0.1 * scale.expected_jnd, 10.0 * scale.expected_jnd, 41),
      .weights_of_thresholds = {},
      .trials = static_cast<int>(scale.quest_trials)};
}

TrialSequence::TrialSequence(Protocol protocol, Plan plan)
    : protocol_(std::move(protocol)), plan_(std::move(plan)) {
  if (protocol_.design == Design::staircase) staircase_.emplace(protocol_.scale.staircase);
  if (protocol_.design == Design::quest_plus)
    quest_.emplace(quest_options_of(protocol_.scale, psychophysics::chance_of(task_of(protocol_))));
}

std::optional<TrialPlan> TrialSequence::next() const {
  if (answered_ >= plan_.size()) return std::nullopt;
  TrialPlan trial = plan_[answered_];
  if (staircase_) {
    if (!trial.practice && staircase_->finished()) return std::nullopt;
    trial.level = trial.practice ? protocol_.scale.staircase.start : staircase_->next();
  } else if (quest_) {
    if (!trial.practice && quest_->finished()) return std::nullopt;
    trial.level = trial.practice ? protocol_.scale.levels.back() : quest_->next();
  }
  return trial;
}

void TrialSequence::answer(std::size_t slot) {
  const std::optional<TrialPlan> trial = next();
  if (!trial) throw std::invalid_argument("the session is over and takes no further answers");
  if (slot >= answers_of(protocol_.design)) {
    throw std::invalid_argument(
        fmt::format("slot {} is no answer; there are {}", slot, answers_of(protocol_.design)));
  }
  const bool is_right = slot == trial->right(protocol_);
  if (staircase_ && !trial->practice) staircase_->answer(is_right);
  if (quest_ && !trial->practice) quest_->answer(is_right);
  ++answered_;
}

bool TrialSequence::break_due() const noexcept {
  if (protocol_.break_every == 0 || !next()) return false;
  const auto practice = static_cast<std::size_t>(std::ranges::count_if(plan_, &TrialPlan::practice));
  return answered_ > practice && (answered_ - practice) % protocol_.break_every == 0;
}

}  // namespace kerf::bench
