#include "session/director.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

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
  for (const RecordedTrial& trial : store.trials()) {
    if (trial.is_void()) {
      (void)sequence.repeat();
    } else {
      sequence.answer(trial.answer);
    }
  }
  return sequence;
}

}  // namespace

Director::Director(SessionStore& store, BlindRendering& rendering, Subject& subject,
                   drivers::DeviceInfo device, Options options)
    : store_(store),
      rendering_(rendering),
      subject_(subject),
      device_(std::move(device)),
      axes_(axes_of(device_)),
      options_(std::move(options)),
      sequence_(resumed(store)),
      slots_(slots_of(store.protocol())) {
  const double longest_s = store.protocol().longest_s + trace_margin_s;
  trial_.trace.resize(static_cast<std::size_t>(std::ceil(longest_s / options_.period_s)));
}

void Director::poll(double now_s) {
  now_s_ = now_s;
  if (over()) return;
  if (phase_ == Phase::trial && playing_)
    felt_s_[*playing_] = std::max(felt_s_[*playing_], now_s_ - playing_since_s_);
  // One at a time: what comes next may be meant for what is shown then.
  if (phase_ == Phase::trial) meter_rows();
  if (const auto action = subject_.next()) act(*action);
  if (phase_ == Phase::ready) follow_wait();
  if (phase_ == Phase::ready) follow_guide();
  if (phase_ == Phase::trial) follow_sequence();
  if (phase_ == Phase::trial && first_felt_s_ && !answerable_s_ && may_answer())
    answerable_s_ = now_s_ - *first_felt_s_;
  if (phase_ == Phase::trial && playing_ && time_is_over()) {
    rendering_.play(std::nullopt);
    rendering_.let_go();
    playing_.reset();
    refuse("time_is_over");
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
      return refuse("refused_decline");
    case SubjectAction::Kind::go_on:
      return go_on();
    case SubjectAction::Kind::play:
      return switch_to(action.slot);
    case SubjectAction::Kind::answer:
      return answer(action);
    case SubjectAction::Kind::slip:
      return slip();
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
      return prepare_trial();
    case Phase::pause:
      if (now_s_ - since_s_ < protocol.break_s) return refuse("refused_break");
      return prepare_trial();
    case Phase::ready:
      if (protocol.rules.start == TrialStart::key && now_s_ - since_s_ >= protocol.rules.pause_s)
        return start_with_guide();
      return refuse("refused_go_on");
    default:
      return refuse("refused_go_on");
  }
}

/// After the trials of a tissue, or of all, as often as it was not filled in yet: also in a later run.
bool Director::questionnaire_is_due() const {
  const Questionnaire& asked = store_.protocol().questionnaire;
  if (!asked.is_asked()) return false;
  std::set<std::size_t> begun;
  for (const RecordedTrial& trial : store_.trials()) {
    if (!trial.what.practice) begun.insert(trial.what.tissue);
  }
  const std::optional<TrialPlan> next = sequence_.next();
  if (!asked.after_blocks) return !next && !begun.empty() && store_.questionnaires().empty();
  if (next) begun.erase(next->tissue);
  return begun.size() > store_.questionnaires().size();
}

void Director::answer_item(double number) {
  const Questionnaire& asked = store_.protocol().questionnaire;
  if (!(number >= 0.0 && number <= questionnaire_most && std::remainder(number, questionnaire_step) == 0.0))
    return refuse("refused_no_answer");
  scores_.push_back(number);
  if (scores_.size() < asked.items.size()) return;
  const FilledQuestionnaire filled{
      .tissue = store_.trials().back().what.tissue, .scores = scores_, .at = schema::new_header("").created};
  if (!stored([&] { store_.append(filled); })) return scores_.pop_back();
  after_trial();
}

void Director::prepare_trial() {
  if (questionnaire_is_due()) {
    scores_.clear();
    phase_ = Phase::questionnaire;
    return;
  }
  const TrialRules& rules = store_.protocol().rules;
  const auto next = sequence_.next();
  const bool waits = rules.pause_s > 0.0 || rules.start != TrialStart::at_once;
  if (!next || (!waits && !is_led(next->practice))) return start_trial();
  phase_ = Phase::ready;
  since_s_ = now_s_;
  cycle_waited_in_.reset();
}

bool Director::is_led(bool practice) const noexcept {
  const auto& guide = store_.protocol().guide;
  return guide && guide->leads(practice);
}

void Director::start_with_guide() {
  const auto next = sequence_.next();
  if (!next || !is_led(next->practice)) return start_trial();
  if (!cycle_waited_in_)
    cycle_waited_in_ = std::floor(rendering_.guide_time_s() / store_.protocol().guide->cycle_s());
}

void Director::follow_guide() {
  if (!cycle_waited_in_) return;
  if (std::floor(rendering_.guide_time_s() / store_.protocol().guide->cycle_s()) > *cycle_waited_in_)
    start_trial();
}

void Director::follow_wait() {
  const TrialRules& rules = store_.protocol().rules;
  if (now_s_ - since_s_ < rules.pause_s || rules.start == TrialStart::key) return;
  if (rules.start == TrialStart::at_once || is_out_of_contact()) start_with_guide();
}

/// Of every sample alike, so that the wait tells nothing of those to come.
bool Director::is_out_of_contact() const {
  if (!options_.position) return true;
  const drivers::Axes position = options_.position();
  return std::ranges::none_of(store_.protocol().samples, [&](const SessionSample& sample) {
    return TouchedAt{.contact = sample.law.contact, .axis = axes_for(sample.law, device_).front()}.by(
        position);
  });
}

void Director::start_trial() {
  const auto next = sequence_.next();
  if (!next && sequence_.practised() == false && store_.protocol().rules.practice_until.ends_session)
    return finish(SessionEnd::quit, "quit", "practice did not come to its criterion");
  if (!next) return finish(SessionEnd::finished, "finished", "");
  planned_ = *next;
  const StatesBetween states = store_.protocol().rules.states;
  trial_.laws.clear();
  trial_.fresh.clear();
  trial_.gains.clear();
  trial_.touched.clear();
  for (const PlayedLaw& one : played(store_.protocol(), planned_)) {
    trial_.laws.emplace_back(one.law.law, one.law.contact, axes_for(one.law, device_));
    trial_.gains.push_back(one.gain);
    if (states == StatesBetween::out_of_contact)
      trial_.touched.push_back({.contact = one.law.contact, .axis = axes_for(one.law, device_).front()});
  }
  if (states != StatesBetween::run_on) trial_.fresh = trial_.laws;
  trial_.led_axis.reset();
  if (is_led(planned_.practice) && store_.protocol().guide->has_target())
    trial_.led_axis = axes_for(store_.protocol().samples[planned_.pair[0]].law, device_).front();
  trial_.slots = slots_;
  trial_.law_of = planned_.slots;
  trial_.rows = 0;
  metered_ = 0;
  meter_.emplace(axes_, slots_, trial_.led_axis);
  is_explored_ =
      store_.protocol().presentation == Presentation::sequence || !rules_of_trial().explore.is_asked();
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
  if (phase_ != Phase::trial || slot >= slots_) return refuse("refused_feel");
  if (store_.protocol().presentation == Presentation::sequence) return refuse("refused_sequence");
  if (time_is_over()) return refuse("time_is_over");
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
    if (intervals_begun_ == slots_) {
      ++intervals_begun_;
      rendering_.let_go();
    }
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

void Director::answer(const SubjectAction& given) {
  const Protocol& protocol = store_.protocol();
  if (phase_ == Phase::questionnaire) return answer_item(given.number);
  if (phase_ != Phase::trial && phase_ != Phase::unstored) return refuse("refused_answer");
  const std::optional<NumberRange> range = written_numbers_of(protocol);
  const std::size_t slot = range ? 0 : given.slot;
  if (slot >= choices_of(protocol) || (range && !range->holds(given.number)))
    return refuse("refused_no_answer");
  if (!may_answer()) {
    return refuse(protocol.presentation == Presentation::sequence ? TextName("refused_still_playing")
                  : protocol.rules.explore.is_asked()             ? TextName("refused_unexplored")
                                                                  : TextName("refused_unfelt"));
  }
  if (phase_ == Phase::unstored && answer_ == no_answer) return refuse("refused_answer");
  answer_ = slot;
  number_ = range ? given.number : std::numeric_limits<double>::quiet_NaN();
  if (phase_ == Phase::unstored) return end_trial();  // it was felt, and how long that took is known
  response_s_ = first_felt_s_ ? now_s_ - *first_felt_s_ : 0.0;
  if (!answerable_s_) answerable_s_ = response_s_;
  playing_.reset();
  rendering_.end();
  phase_ = Phase::fading;
}

bool Director::may_slip() const noexcept {
  return store_.protocol().rules.slip && phase_ == Phase::trial && first_felt_s_;
}

void Director::slip() {
  if (phase_ == Phase::unstored && answer_ == no_answer) return end_trial();
  if (!may_slip()) return refuse("refused_slip");
  answer_ = no_answer;
  number_ = std::numeric_limits<double>::quiet_NaN();
  response_s_ = std::numeric_limits<double>::quiet_NaN();
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
    refuse("not_stored", {{"reason", error.code().message()}});
    return false;
  }
}

void Director::meter_rows() {
  const std::size_t rows = std::atomic_ref(trial_.rows).load(std::memory_order_acquire);
  for (; metered_ < rows; ++metered_) meter_->take(trial_.trace[metered_]);
  if (!is_explored_) is_explored_ = is_explored(meter_->quality(), store_.protocol().rules.explore);
}

std::vector<VoidReason> Director::reasons_to_void() const {
  if (answer_ == no_answer) return {VoidReason::slipped};
  return void_reasons_of(meter_->quality(), rules_of_trial());
}

/// A catch trial may have a sample without force, of which nothing can be felt.
TrialRules Director::rules_of_trial() const {
  TrialRules rules = store_.protocol().rules;
  if (planned_.is_catch) rules.explore = {};
  return rules;
}

void Director::end_trial() {
  meter_rows();
  RecordedTrial recorded{
      .what = planned_,
      .answer = answer_,
      .number = number_,
      .response_s = response_s_,
      .answerable_s = *answerable_s_,
      .switches = switches_,
      .void_reasons = reasons_to_void(),
      .at = schema::new_header("").created,
      .axes = axes_,
      .trace = {trial_.trace.begin(), trial_.trace.begin() + static_cast<std::ptrdiff_t>(metered_)},
      .channels = {}};
  if (trial_.led_axis) recorded.channels = channels_of_guide(axes_[*trial_.led_axis]);
  if (!stored([&] { store_.append(recorded); })) {
    phase_ = Phase::unstored;
    return;
  }
  bool is_left_out = false;
  if (recorded.is_void()) {
    is_left_out = !sequence_.repeat();
  } else {
    sequence_.answer(answer_);
  }
  if (options_.recorded) options_.recorded(recorded, is_left_out);
  if (options_.progress) options_.progress(sequence_.answered(), sequence_.at_most());
  since_s_ = now_s_;
  if (std::ranges::count(recorded.void_reasons, VoidReason::unexplored) > 0) refuse("void_unexplored");
  if (std::ranges::count(recorded.void_reasons, VoidReason::off_target) > 0) refuse("void_off_target");
  if (answer_ == no_answer) return after_trial();
  if (planned_.practice && store_.protocol().feedback && store_.protocol().design != Design::preference) {
    phase_ = Phase::feedback;
  } else {
    after_trial();
  }
}

void Director::after_trial() {
  if (!questionnaire_is_due() && sequence_.next() && sequence_.break_due()) {
    phase_ = Phase::pause;
  } else {
    prepare_trial();
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
