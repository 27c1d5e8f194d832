#pragma once

#include <string>
#include <vector>

#include "subject/subject.h"

namespace kerf::test {

inline bench::SubjectView text_view(bench::SessionStage stage, const std::string& text) {
  return {.stage = stage, .study = "Liver", .text = text, .may_go_on = true};
}

/// A and B, the first one plays, the subject may switch and answer.
inline bench::SubjectView free_trial(std::size_t number) {
  return {.stage = bench::SessionStage::trial,
          .study = "Liver",
          .text = "Which is softer?",
          .labels = {"A", "B", "X"},
          .answers = 2,
          .playing = 0,
          .may_switch = true,
          .may_answer = true,
          .trial = number,
          .at_most = 24};
}

/// 1, 2 and 3 have been played, the subject may answer.
inline bench::SubjectView sequence_trial(std::size_t number) {
  bench::SubjectView view = free_trial(number);
  view.labels = {"1", "2", "3"};
  view.answers = 3;
  view.playing.reset();
  view.may_switch = false;
  return view;
}

/// One slot has been played; the answers are words.
inline bench::SubjectView words_trial(std::size_t number) {
  bench::SubjectView view = sequence_trial(number);
  view.labels = {"A"};
  view.answers = 4;
  view.answer_labels = {"no, sure", "no, guessing", "yes, guessing", "yes, sure"};
  return view;
}

/// "play 1", "answer 0", "go_on"; "nothing".
inline std::string in_words(const std::optional<bench::SubjectAction>& action) {
  using Kind = bench::SubjectAction::Kind;
  if (!action) return "nothing";
  switch (action->kind) {
    case Kind::go_on:
      return "go on";
    case Kind::decline:
      return "decline";
    case Kind::play:
      return "play " + std::to_string(action->slot);
    case Kind::answer:
      return "answer " + std::to_string(action->slot);
    case Kind::quit:
      return "quit";
    case Kind::slip:
      return "slip";
  }
  return "?";
}

}  // namespace kerf::test
