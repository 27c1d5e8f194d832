#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "protocol/trial_sequence.h"
#include "sealed/session_store.h"
#include "session/blind_rendering.h"
#include "subject/subject.h"

namespace kerf::bench {

enum class SessionEnd : std::uint8_t { none, finished, quit, declined };

/// Leads a subject through a session: texts, practice, trials, breaks. It has no clock and never waits:
/// poll() is told the time, from one thread, every few milliseconds or in every tick of virtual time.
///
/// What the subject may see does not depend on the order of the samples, save for the feedback of practice.
/// An answer out of turn is refused in words: before every slot was felt, while intervals play, twice.
class Director {
 public:
  struct Options {
    double period_s = 1e-3;
    /// Told after every answer: how many, of how many at most. The experimenter's screen.
    std::function<void(std::size_t answered, std::size_t at_most)> progress;
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
    trial,
    fading,
    unstored,  ///< the answer could not be written: the question is open still
    feedback,
    pause,
    leaving,
    over
  };

  void act(const SubjectAction& action);
  void go_on();
  void answer(std::size_t slot);
  void switch_to(std::size_t slot);
  void start_trial();
  void follow_sequence();
  void end_trial();
  /// Whether an entry is on the disk; why not is told to the subject, who may try again.
  bool stored(const std::function<void()>& store);
  void after_trial();
  void finish(SessionEnd end, const std::string& kind, const std::string& text);
  void refuse(std::string why) { notice_ = std::move(why); }
  [[nodiscard]] bool all_felt() const noexcept;
  [[nodiscard]] bool time_is_over() const noexcept;
  [[nodiscard]] bool may_answer() const noexcept { return all_felt() || time_is_over(); }
  [[nodiscard]] SubjectView view() const;
  void view_of_trial(SubjectView& view) const;

  SessionStore& store_;
  BlindRendering& rendering_;
  Subject& subject_;
  drivers::DeviceInfo device_;
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
  std::optional<std::size_t> playing_;
  double playing_since_s_ = 0.0;
  std::optional<double> first_felt_s_;
  std::optional<double> answerable_s_;  ///< after that, when it could be answered first
  std::array<double, max_slots> felt_s_{};
  std::size_t switches_ = 0;
  std::size_t intervals_begun_ = 0;
  std::size_t answer_ = 0;
  double response_s_ = 0.0;
  std::string leave_kind_;
  std::string leave_text_;
};

}  // namespace kerf::bench
