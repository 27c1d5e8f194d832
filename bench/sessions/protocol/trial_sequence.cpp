#include "protocol/trial_sequence.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

/// Practice, a tissue, or ten trials of an adaptive design with the catch trials among them.
std::vector<std::size_t> blocks_of(const Protocol& protocol, const Plan& plan) {
  std::vector<std::size_t> blocks;
  std::size_t before = 0;
  for (const TrialPlan& trial : plan) {
    if (trial.practice) {
      blocks.push_back(0);
    } else if (!is_adaptive(protocol.design)) {
      blocks.push_back(1 + trial.tissue);
    } else {
      // A catch trial is in the block of the trial that it follows.
      blocks.push_back(1 + (trial.is_catch ? before - 1 : before) / block_of_slots);
      before += trial.is_catch ? 0 : 1;
    }
  }
  return blocks;
}

}  // namespace

psychophysics::QuestPlusOptions quest_options_of(const IntensityScale& scale, double guess) {
  psychophysics::QuestPlusOptions options = scale.quest;
  options.shape = scale.shape;
  options.guess = guess;
  options.intensities = scale.levels;
  options.trials = static_cast<int>(scale.quest_trials);
  if (options.thresholds.empty())
    options.thresholds =
        psychophysics::geometric_grid(0.1 * scale.expected_jnd, 10.0 * scale.expected_jnd, 41);
  return options;
}

TrialSequence::TrialSequence(Protocol protocol, Plan plan)
    : protocol_(std::move(protocol)), plan_(std::move(plan)) {
  order_.resize(plan_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  block_ = blocks_of(protocol_, plan_);
  if (protocol_.design == Design::staircase) {
    for (const psychophysics::StaircaseOptions& options : protocol_.scale.staircases())
      staircases_.emplace_back(options);
  }
  if (protocol_.design == Design::quest_plus)
    quest_.emplace(quest_options_of(protocol_.scale, psychophysics::chance_of(task_of(protocol_))));
}

std::optional<std::size_t> TrialSequence::track_at_turn(std::size_t planned) const {
  for (std::size_t i = 0; i < staircases_.size(); ++i) {
    const std::size_t track = (planned + i) % staircases_.size();
    if (!staircases_[track].finished()) return track;
  }
  return std::nullopt;
}

std::optional<TrialPlan> TrialSequence::next() const {
  if (answered_ >= order_.size()) return std::nullopt;
  TrialPlan trial = plan_[order_[answered_]];
  if (!staircases_.empty() && trial.practice) {
    trial.level = protocol_.scale.staircase.start;
    for (const psychophysics::StaircaseOptions& other : protocol_.scale.interleaved)
      trial.level = std::max(trial.level, other.start);
  } else if (!staircases_.empty()) {
    const std::optional<std::size_t> track = track_at_turn(trial.track);
    if (!track) return std::nullopt;
    if (trial.is_catch) return trial;
    trial.track = *track;
    trial.level = staircases_[*track].next();
  } else if (quest_) {
    if (!trial.practice && quest_->finished()) return std::nullopt;
    if (trial.is_catch) return trial;
    trial.level = trial.practice ? protocol_.scale.levels.back() : quest_->next();
  }
  return trial;
}

void TrialSequence::answer(std::size_t slot) {
  const std::optional<TrialPlan> trial = next();
  if (!trial) throw std::invalid_argument("the session is over and takes no further answers");
  if (slot >= choices_of(protocol_)) {
    throw std::invalid_argument(
        fmt::format("slot {} is no answer; there are {}", slot, choices_of(protocol_)));
  }
  const bool is_right = slot == trial->right(protocol_);
  const bool is_ruled = !trial->practice && !trial->is_catch;
  if (!staircases_.empty() && is_ruled) staircases_[trial->track].answer(is_right);
  if (quest_ && is_ruled) quest_->answer(is_right);
  ++answered_;
  if (!trial->practice) return;
  practice_right_.push_back(is_right);
  judge_practice();
}

/// After an answer of practice, or a trial of it that is left out.
void TrialSequence::judge_practice() {
  const PracticeCriterion& until = protocol_.rules.practice_until;
  if (until.right == 0) return;
  const auto last =
      practice_right_.end() - static_cast<std::ptrdiff_t>(std::min(until.of, practice_right_.size()));
  const bool is_reached =
      static_cast<std::size_t>(std::count(last, practice_right_.end(), true)) >= until.right;
  const auto at = order_.begin() + static_cast<std::ptrdiff_t>(answered_);
  const auto end = std::find_if(at, order_.end(), [&](std::size_t later) { return !plan_[later].practice; });
  if (!is_reached && at != end) return;
  practised_ = is_reached;
  const auto rest = !is_reached && until.ends_session ? order_.end() : end;
  skipped_ += static_cast<std::size_t>(rest - at);
  order_.erase(at, rest);
}

bool TrialSequence::repeat() {
  if (!next()) throw std::invalid_argument("the session is over and takes no further answers");
  const std::size_t planned = order_[answered_++];
  const auto given = order_.begin() + static_cast<std::ptrdiff_t>(answered_);
  if (static_cast<std::size_t>(std::count(order_.begin(), given, planned)) > protocol_.rules.repeats) {
    if (plan_[planned].practice) judge_practice();
    return false;
  }
  const auto end =
      std::find_if(given, order_.end(), [&](std::size_t later) { return block_[later] != block_[planned]; });
  order_.insert(end, planned);
  return true;
}

bool TrialSequence::break_due() const noexcept {
  if (protocol_.break_every == 0 || !next()) return false;
  const auto given = order_.begin() + static_cast<std::ptrdiff_t>(answered_);
  const auto counted = static_cast<std::size_t>(
      std::count_if(order_.begin(), given, [&](std::size_t each) { return !plan_[each].practice; }));
  return counted > 0 && counted % protocol_.break_every == 0;
}

}  // namespace kerf::bench
