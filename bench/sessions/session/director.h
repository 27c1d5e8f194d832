#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "protocol/trial_sequence.h"
#include "sealed/session_store.h"
#include "sealed/trials/trial_quality.h"
#include "session/blind_rendering.h"
#include "subject/subject.h"

namespace kerf::bench {

enum class SessionEnd : std::uint8_t { none, finished, quit, declined };

/// Leads a subject through a session: texts, practice, trials, breaks. It has no clock and never waits:
/// poll() is told the time, from one thread, every few milliseconds or in every tick of virtual time.
///
/// What the subject may see does not depend on the order of the samples, save for the feedback of practice.
/// An answer out of turn is refused in words: before every slot was felt, while intervals play, twice. The
/// words are the same whichever slot lacks something.
class Director {
 public:
  struct Options {
    double period_s = 1e-3;
    /// Told after every answer: how many, of how many at most. The experimenter's screen.
    std::function<void(std::size_t answered, std::size_t at_most)> progress;
    /// Told of every trial that was stored, with its trace; and whether it is void and does not come again.
    std::function<void(const RecordedTrial& trial, bool is_left_out)> recorded;
    /// Where the tool is, for protocols whose trials begin out of contact.
    std::function<drivers::Axes()> position;
  };

  /// Takes the session up where its recorded answers end.
  Director(SessionStore& store, BlindRendering& rendering, Subject& subject, drivers::DeviceInfo device,
           Options options);

  /// An answer or a consent that cannot be written, as on a full disk, leaves the question open.
  /// @throws std::system_error: the end could not be written.
  void poll(double now_s);
  /// The subject, the experimenter or the device ends the session for now; poll() goes on until over().
  void quit(const std::string& why);
  [[nodiscard]] bool over() const noexcept { return phase_ == Phase::over; }
  [[nodiscard]] SessionEnd end() const noexcept { return end_; }
  [[nodiscard]] const TrialSequence& sequence() const noexcept { return sequence_; }

 private:
  enum class Phase : std::uint8_t {
    welcome,
    consent,
    instructions,
    ready,  ///< pause, or waiting for a key or the tool, ahead of a trial
    trial,
    fading,
    unstored,  ///< the answer could not be written: the question is open still
    feedback,
    pause,
    questionnaire,
    leaving,
    over
  };

  void act(const SubjectAction& action);
  void go_on();
  void answer(const SubjectAction& given);
  void switch_to(std::size_t slot);
  void slip();
  /// The pause and the wait ahead of a trial, if the protocol has them.
  void prepare_trial();
  void follow_wait();
  /// At once, or with the next cycle of the guide.
  void start_with_guide();
  void follow_guide();
  [[nodiscard]] bool is_led(bool practice) const noexcept;
  /// The guide is to be seen, and felt where it is to be, until all has been felt.
  [[nodiscard]] bool shows_guide() const;
  void start_trial();
  void follow_sequence();
  /// What the tick has recorded since it was asked last.
  void meter_rows();
  [[nodiscard]] std::vector<VoidReason> reasons_to_void() const;
  [[nodiscard]] TrialRules rules_of_trial() const;
  void end_trial();
  /// Whether an entry is on the disk; why not is told to the subject, who may try again.
  bool stored(const std::function<void()>& store);
  void after_trial();
  [[nodiscard]] bool questionnaire_is_due() const;
  void answer_item(double number);
  void finish(SessionEnd end, const std::string& kind, const std::string& text);
  void refuse(TextName why, std::initializer_list<TextValue> values = {}) {
    notice_ = (*store_.protocol().texts)(why, values);
  }
  [[nodiscard]] bool may_slip() const noexcept;
  [[nodiscard]] bool is_out_of_contact() const;
  [[nodiscard]] bool all_felt() const noexcept;
  [[nodiscard]] bool time_is_over() const noexcept;
  [[nodiscard]] bool may_answer() const noexcept { return (all_felt() && is_explored_) || time_is_over(); }
  [[nodiscard]] SubjectView view() const;
  void view_of_trial(SubjectView& view) const;

  SessionStore& store_;
  BlindRendering& rendering_;
  Subject& subject_;
  drivers::DeviceInfo device_;
  std::vector<schema::Axis> axes_;
  Options options_;
  TrialSequence sequence_;
  std::size_t slots_;

  Phase phase_ = Phase::welcome;
  SessionEnd end_ = SessionEnd::none;
  double now_s_ = 0.0;
  double since_s_ = 0.0;  ///< when the phase began
  std::string notice_;
  std::optional<SubjectView> shown_;

  // Of the trial.
  TrialPlan planned_;
  TrialRendering trial_;
  std::optional<TrialMeter> meter_;
  std::size_t metered_ = 0;                ///< rows
  std::optional<double> cycle_waited_in_;  ///< of the guide, ahead of a trial that begins with the next one
  bool is_explored_ = true;                ///< as the protocol asks; in a sequence the end decides
  std::optional<std::size_t> playing_;
  double playing_since_s_ = 0.0;
  std::optional<double> first_felt_s_;
  std::optional<double> answerable_s_;  ///< after that, when it could be answered first
  std::array<double, max_slots> felt_s_{};
  std::size_t switches_ = 0;
  std::size_t intervals_begun_ = 0;
  std::size_t answer_ = 0;  ///< or no_answer
  double number_ = 0.0;     ///< that was written; NaN: none
  double response_s_ = 0.0;
  std::vector<double> scores_;  ///< of the questionnaire at hand
  std::string leave_kind_;
  std::string leave_text_;
};

}  // namespace kerf::bench
