#include "sealed/trials/quality_tally.h"

#include <algorithm>
#include <cmath>

#include "sealed/trials/trial_quality.h"

namespace kerf::bench {

QualityTally::QualityTally(const SessionStore& session)
    : slots_(slots_of(session.protocol())), protocol_(session.protocol()) {
  for (std::size_t i = 0; i < session.trials().size(); ++i) add_felt(session.trial(i));
  sums_.counts = counts_of(session);
}

void QualityTally::add(const RecordedTrial& trial, bool is_left_out) {
  add_felt(trial);
  TrialCounts& counts = sums_.counts;
  ++counts.given;
  counts.practice += trial.what.practice ? 1 : 0;
  counts.counted += !trial.is_void() && !trial.what.practice ? 1 : 0;
  counts.voided += trial.is_void() ? 1 : 0;
  counts.left_out += is_left_out ? 1 : 0;
  for (const VoidReason reason : trial.void_reasons) ++counts.by_reason[static_cast<std::size_t>(reason)];
}

void QualityTally::add_felt(const RecordedTrial& trial) {
  if (trial.answer != no_answer && std::isfinite(trial.decision_s())) times_s_.push_back(trial.decision_s());
  if (trial.what.is_catch && !trial.is_void()) {
    ++catches_.trials;
    catches_.right += answer_of_choice(protocol_, trial.answer) == trial.what.right(protocol_) ? 1 : 0;
  }
  const std::optional<TrialQuality> quality = quality_of(trial, slots_);
  sums_.unknown += quality ? 0 : 1;
  if (!quality) return;
  sums_.unfelt += quality->is_felt() || trial.what.is_catch ? 0 : 1;
  sums_.faulty += quality->is_sound() ? 0 : 1;
  sums_.late_ticks += quality->missed_deadlines;
  for (const SlotFelt& slot : quality->slots) {
    sums_.limited_ticks += slot.limited_ticks;
    playing_s_ += slot.playing_s;
    contact_s_ += slot.contact_s;
  }
}

SessionQuality QualityTally::quality(bool is_finished) const {
  SessionQuality sums = sums_;
  const bool has_catches = protocol_.catches.every > 0;
  if (has_catches && is_finished) sums.catches = catches_;
  if (playing_s_ > 0.0 && (is_finished || !has_catches)) sums.contact_share = contact_s_ / playing_s_;
  if (times_s_.empty()) return sums;
  std::vector<double> times_s = times_s_;
  std::ranges::sort(times_s);
  const std::size_t half = times_s.size() / 2;
  sums.median_response_s =
      times_s.size() % 2 == 1 ? times_s[half] : 0.5 * (times_s[half - 1] + times_s[half]);
  sums.slowest_response_s = times_s.back();
  return sums;
}

}  // namespace kerf::bench
