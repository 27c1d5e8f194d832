#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "texts/subject_texts.h"

namespace kerf::bench {

/// Where a session stands, as the subject may know it.
enum class SessionStage {
  welcome,
  consent,
  instructions,
  trial,
  feedback,
  pause,
  finished,
  ready,
  questionnaire
};

/// Everything that a subject's screen may show: the same for every order of the samples. What tells the
/// samples apart is not in it, so that no interface can show it.
struct SubjectView {
  SessionStage stage = SessionStage::welcome;
  std::string study;
  std::string text;                 ///< consent, instructions, the question, what practice was right
  std::vector<std::string> labels;  ///< of the slots: A, B, X
  std::size_t answers = 0;          ///< the first so many of them may be the answer
  /// Words that are the answers where slots are none: "same", "different"; as many as `answers`.
  std::vector<std::string> answer_labels;
  bool in_steps = false;  ///< those words are the steps of one scale
  /// A number is the answer, within these ends, and there are no labels of answers.
  struct AskedNumber {
    double lower = 0.0;
    double upper = 0.0;
    double step = 0.0;              ///< from `lower` on; 0: any number
    std::vector<std::string> ends;  ///< words of a line from one end to the other; none: a number as written

    [[nodiscard]] bool takes(double given) const noexcept {
      return given >= lower && given <= upper && (step == 0.0 || std::remainder(given - lower, step) == 0.0);
    }
    friend bool operator==(const AskedNumber&, const AskedNumber&) = default;
  };
  std::optional<AskedNumber> number;
  std::optional<std::size_t> playing;
  bool may_switch = false;  ///< the subject chooses what plays
  bool may_answer = false;
  bool may_go_on = false;           ///< a break or a text may be left
  bool may_slip = false;            ///< the trial may be taken back
  bool tool_is_waited_for = false;  ///< ahead of a trial, to leave what it touches
  bool guided = false;              ///< the guide leads now
  bool practice = false;
  std::size_t trial = 0;      ///< from 1
  std::size_t at_most = 0;    ///< trials
  bool may_be_fewer = false;  ///< the answers decide when it ends
  bool may_be_more = false;   ///< a trial may come again
  double wait_s = 0.0;        ///< of a break
  std::string notice;         ///< why the last action was refused; empty if it was not
  std::shared_ptr<const SubjectTexts> texts = english_texts();  ///< in which all of it is said

  friend bool operator==(const SubjectView&, const SubjectView&) = default;
};

/// What a subject can do.
struct SubjectAction {
  enum class Kind { go_on, decline, play, answer, quit, slip } kind = Kind::go_on;
  std::size_t slot = 0;                                      ///< of play; of answer which one
  double number = std::numeric_limits<double>::quiet_NaN();  ///< of an answer that is one
};

/// Keyboard, page, buttons of a device: where a subject sees and acts. Both are called from one thread, every
/// few milliseconds, and do not wait.
class Subject {
 public:
  Subject() = default;
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;
  virtual ~Subject() = default;

  virtual void show(const SubjectView& view) = 0;  ///< called when the view has changed
  [[nodiscard]] virtual std::optional<SubjectAction> next() = 0;
};

}  // namespace kerf::bench
