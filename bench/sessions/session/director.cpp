#include "session/director.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "laws/placement.h"
#include "protocol/samples.h"
#include "recordings/axes.h"

namespace kerf::bench {
namespace {

constexpr double least_felt_s = 0.3;    ///< of a slot, after its ramp
constexpr double trace_margin_s = 2.0;  ///< past the longest trial: ramps

bool was_agreed(const schema::Session& session) {
  return std::ranges::any_of(session.entries, [](const auto& entry) { return entry.kind == "consent"; });
}

TrialSequence resumed(const SessionStore& store) {
  TrialSequence sequence(store.protocol(), store.plan());
  for (const RecordedTrial& trial : store.trials()) sequence.answer(trial.answer);
  return sequence;
}

}  // namespace

Director::Director(SessionStore& store, BlindRendering& rendering, Subject& subject,
                   drivers::DeviceInfo device, Options options)
    : store_(store),
      rendering_(rendering),
      subject_(subject),
      device_(std::move(device)),
      options_(std::move(options)),
      sequence_(resumed(store)),
      slots_(slots_of(store.protocol().design)) {
  const double longest_s = store.protocol().longest_s + trace_margin_s;
  trial_.trace.resize(static_cast<std::size_t>(std::ceil(longest_s / options_.period_s)));
}

void Director::poll(double now_s) {
  now_s_ = now_s;
  if (over()) return;
  if (phase_ == Phase::trial && playing_)
    felt_s_[*playing_] = std::max(felt_s_[*playing_], now_s_ - playing_since_s_);
  // One at a time: what comes next may be meant for what is shown then.
  if (const auto action = subject_.next()) act(*action);
  if (phase_ == Phase::trial) follow_sequence();
  if (phase_ == Phase::trial && first_felt_s_ && !answerable_s_ && may_answer())
    answerable_s_ = now_s_ - *first_felt_s_;
  if (phase_ == Phase::trial && playing_ && time_is_over()) {
    rendering_.play(std::nullopt);
    playing_.reset();
    refuse("The time of this trial is over. Please answer.");
  }
  if (phase_ == Phase::fading && rendering_.idle()) end_trial();
  if (phase_ == Phase::leaving && rendering_.idle()) {
    store_.note(leave_kind_, leave_text_);
    phase_ = Phase::over;
  }
  SubjectView now = view();
  if (shown_ == now) return;
  subject_.show(now);
  shown_ = std::move(now);
}

void Director::quit(const std::string& why) {
  if (phase_ != Phase::leaving && !over()) finish(SessionEnd::quit, "quit", why);
}

void Director::act(const SubjectAction& action) {
  notice_.clear();
  switch (action.kind) {
    case SubjectAction::Kind::quit:
      return quit("by the subject");
    case SubjectAction::Kind::decline:
      if (phase_ == Phase::consent) return finish(SessionEnd::declined, "declined", "consent was not given");
      return refuse("There is nothing to decline now.");
    case SubjectAction::Kind::go_on:
      return go_on();
    case SubjectAction::Kind::play:
      return switch_to(action.slot);
    case SubjectAction::Kind::answer:
      return answer(action.slot);
  }
}

void Director::go_on() {
  const Protocol& protocol = store_.protocol();
  const auto enter = [&](Phase phase) {
    phase_ = phase;
    since_s_ = now_s_;
  };
  switch (phase_) {
    case Phase::welcome:
      if (!protocol.consent.empty() && !was_agreed(store_.session())) return enter(Phase::consent);
      [[fallthrough]];
    case Phase::consent:
      if (phase_ == Phase::consent && !stored([&] { store_.note("consent", "given"); })) return;
      if (!protocol.instructions.empty()) return enter(Phase::instructions);
      [[fallthrough]];
    case Phase::instructions:
    case Phase::feedback:
      return start_trial();
    case Phase::pause:
      if (now_s_ - since_s_ < protocol.break_s) return refuse("The break is not over yet.");
      return start_trial();
    default:
      return refuse("There is nothing to go on with now.");
  }
}

void Director::start_trial() {
  const auto next = sequence_.next();
  if (!next) return finish(SessionEnd::finished, "finished", "");
  planned_ = *next;
  trial_.laws.clear();
  trial_.gains.clear();
  for (const PlayedLaw& one : played(store_.protocol(), planned_)) {
    trial_.laws.emplace_back(one.law.law, one.law.contact, axes_for(one.law, device_));
    trial_.gains.push_back(one.gain);
  }
  trial_.slots = slots_;
  trial_.law_of = planned_.slots;
  trial_.rows = 0;
  playing_.reset();
  first_felt_s_.reset();
  answerable_s_.reset();
  felt_s_ = {};
  switches_ = 0;
  intervals_begun_ = 0;
  phase_ = Phase::trial;
  since_s_ = now_s_;
  rendering_.begin(trial_);
}

void Director::switch_to(std::size_t slot) {
  if (phase_ != Phase::trial || slot >= slots_) return refuse("There is nothing to feel now.");
  if (store_.protocol().presentation == Presentation::sequence)
    return refuse("The samples come by themselves, one after the other.");
  if (time_is_over()) return refuse("The time of this trial is over. Please answer.");
  if (playing_ == slot) return;
  if (playing_) ++switches_;
  if (!first_felt_s_) first_felt_s_ = now_s_;
  playing_ = slot;
  playing_since_s_ = now_s_;
  rendering_.play(slot);
}

/// The intervals of a sequence: each at its time, with a pause of zero force ahead of it.
void Director::follow_sequence() {
  const Protocol& protocol = store_.protocol();
  if (protocol.presentation != Presentation::sequence || intervals_begun_ > slots_) return;
  const double each_s = protocol.gap_s + protocol.interval_s;
  const double at_s = now_s_ - since_s_ - static_cast<double>(intervals_begun_) * each_s;
  if (playing_ && at_s >= 0.0) {
    rendering_.play(std::nullopt);
    playing_.reset();
    if (intervals_begun_ == slots_) ++intervals_begun_;
  }
  if (intervals_begun_ < slots_ && at_s >= protocol.gap_s) {
    if (!first_felt_s_) first_felt_s_ = now_s_;
    playing_ = intervals_begun_++;
    playing_since_s_ = now_s_;
    rendering_.play(*playing_);
  }
}

bool Director::all_felt() const noexcept {
  const Protocol& protocol = store_.protocol();
  if (protocol.presentation == Presentation::sequence) return intervals_begun_ > slots_;
  const double least_s = protocol.ramp_s + least_felt_s;
  return std::all_of(felt_s_.begin(), felt_s_.begin() + static_cast<std::ptrdiff_t>(slots_),
                     [&](double felt_s) { return felt_s >= least_s; });
}

bool Director::time_is_over() const noexcept {
  return first_felt_s_ && now_s_ - *first_felt_s_ >= store_.protocol().longest_s;
}

void Director::answer(std::size_t slot) {
  const Protocol& protocol = store_.protocol();
  if (phase_ != Phase::trial && phase_ != Phase::unstored) return refuse("There is nothing to answer now.");
  if (slot >= answers_of(protocol.design)) return refuse("That is none of the answers.");
  if (!may_answer()) {
    return refuse(protocol.presentation == Presentation::sequence
                      ? "Please wait until all of them have played."
                      : "Please feel every one of them first, each for a moment.");
  }
  answer_ = slot;
  if (phase_ == Phase::unstored) return end_trial();  // it was felt, and how long that took is known
  response_s_ = first_felt_s_ ? now_s_ - *first_felt_s_ : 0.0;
  if (!answerable_s_) answerable_s_ = response_s_;
  playing_.reset();
  rendering_.end();
  phase_ = Phase::fading;
}

bool Director::stored(const std::function<void()>& store) {
  try {
    store();
    return true;
  } catch (const std::system_error& error) {
    refuse(fmt::format("That could not be stored ({}). Please call the experimenter, and try again.",
                       error.code().message()));
    return false;
  }
}

void Director::end_trial() {
  RecordedTrial recorded{
      .what = planned_,
      .answer = answer_,
      .response_s = response_s_,
      .answerable_s = *answerable_s_,
      .switches = switches_,
      .at = schema::new_header("").created,
      .axes = axes_of(device_),
      .trace = {trial_.trace.begin(), trial_.trace.begin() + static_cast<std::ptrdiff_t>(trial_.rows)}};
  if (!stored([&] { store_.append(recorded); })) {
    phase_ = Phase::unstored;
    return;
  }
  sequence_.answer(answer_);
  if (options_.progress) options_.progress(sequence_.answered(), sequence_.at_most());
  since_s_ = now_s_;
  if (planned_.practice && store_.protocol().feedback && store_.protocol().design != Design::preference) {
    phase_ = Phase::feedback;
  } else {
    after_trial();
  }
}

void Director::after_trial() {
  if (sequence_.next() && sequence_.break_due()) {
    phase_ = Phase::pause;
  } else {
    start_trial();
  }
}

void Director::finish(SessionEnd end, const std::string& kind, const std::string& text) {
  end_ = end;
  leave_kind_ = kind;
  leave_text_ = text;
  playing_.reset();
  if (!rendering_.idle()) rendering_.end();
  phase_ = Phase::leaving;
}

}  // namespace kerf::bench
