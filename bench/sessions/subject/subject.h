#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace kerf::bench {

/// Where a session stands, as the subject may know it.
enum class SessionStage { welcome, consent, instructions, trial, feedback, pause, finished };

/// Everything that a subject's screen may show: the same for every order of the samples. What tells the
/// samples apart is not in it, so that no interface can show it.
struct SubjectView {
  SessionStage stage = SessionStage::welcome;
  std::string study;
  std::string text;                 ///< consent, instructions, the question, what practice was right
  std::vector<std::string> labels;  ///< of the slots: A, B, X
  std::size_t answers = 0;          ///< the first so many of them may be the answer
  std::optional<std::size_t> playing;
  bool may_switch = false;  ///< the subject chooses what plays
  bool may_answer = false;
  bool may_go_on = false;  ///< a break or a text may be left
  bool practice = false;
  std::size_t trial = 0;      ///< from 1
  std::size_t at_most = 0;    ///< trials
  bool may_be_fewer = false;  ///< the answers decide when it ends
  double wait_s = 0.0;        ///< of a break
  std::string notice;         ///< why the last action was refused; empty if it was not

  friend bool operator==(const SubjectView&, const SubjectView&) = default;
};

/// What a subject can do.
struct SubjectAction {
  enum class Kind { go_on, decline, play, answer, quit } kind = Kind::go_on;
  std::size_t slot = 0;  ///< of play and answer
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
