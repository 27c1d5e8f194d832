#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "subject/subject.h"
#include "subject/subject_rules.h"

namespace kerf::bench {

/// What single keys mean: a label (or 1, 2, 3 for the first, second, third) feels it where the subject may
/// switch, and Enter and then the label answers; where the subject may not, the label answers. Answers that
/// are words have numbers. An answer that is a number is typed, and Enter gives it. Space goes on. Q and then
/// Y stops.
class SubjectKeys {
 public:
  static constexpr char escape = '\x1b';

  void show(const SubjectView& view);
  [[nodiscard]] std::optional<SubjectAction> press(char key);

  [[nodiscard]] std::string what_keys_do() const;
  /// Why the last key did nothing; empty if it did.
  [[nodiscard]] const std::string& hint() const noexcept { return hint_; }

 private:
  enum class Waits { for_anything, for_the_answer, for_yes };
  std::optional<SubjectAction> press_in_trial(char key);
  std::optional<SubjectAction> press_of_number(char key);
  std::optional<SubjectAction> play(std::size_t slot);
  std::optional<SubjectAction> answer(std::size_t slot);

  SubjectView view_;
  TrialManner manner_;
  Waits waits_ = Waits::for_anything;
  std::string typed_;  ///< of a number
  std::string hint_;
};

/// The slot of a label, in either case, or of a number from 1; nothing if there is none.
[[nodiscard]] std::optional<std::size_t> slot_of(const SubjectView& view, std::string_view label);

/// The answer of a label, in either case, or of a number from 1; nothing if there is none.
[[nodiscard]] std::optional<std::size_t> answer_of(const SubjectView& view, std::string_view label);

/// What stands for a number that a person writes, with a point or a comma; nothing if it is none.
[[nodiscard]] std::optional<double> number_in(std::string_view text);

/// Commands in lines, for scripts and for screens of braille: "play A", "answer B" (or "answer 12.5"), "go
/// on" (or "agree"), "decline", "quit"; in English, and as the subject's texts call them. Nothing if a line
/// is none of them. @throws nothing; whether the view permits it is not asked here.
[[nodiscard]] std::optional<SubjectAction> command_of(const SubjectView& view, std::string_view line);

}  // namespace kerf::bench
