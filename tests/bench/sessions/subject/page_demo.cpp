// Serves the subject's page with a session that is a script: every stage, a trial of either presentation. Its
// address goes to standard output, and so does every action. For page_browser_test.py, and to look at: run it
// and open the address.

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include "subject/subject_page.h"

namespace {

using namespace kerf::bench;
using Kind = SubjectAction::Kind;

constexpr const char* study = "Cutting liver";

SubjectView text_view(SessionStage stage, const std::string& text) {
  return {.stage = stage, .study = study, .text = text, .may_go_on = true, .at_most = 24};
}

SubjectView trial_view(std::size_t number, std::vector<std::string> labels, std::size_t answers,
                       const std::string& question) {
  return {.stage = SessionStage::trial,
          .study = study,
          .text = question,
          .labels = std::move(labels),
          .answers = answers,
          .trial = number,
          .at_most = 24};
}

SubjectAction wait_for_action(ServedSubject& subject) {
  while (true) {
    if (const auto action = subject.next()) {
      std::cout << "action " << static_cast<int>(action->kind) << ' ' << action->slot << std::endl;
      if (action->kind == Kind::quit || action->kind == Kind::decline) std::exit(0);
      return *action;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

void show_text(ServedSubject& subject, const SubjectView& view) {
  subject.show(view);
  wait_for_action(subject);
}

void free_trial(ServedSubject& subject, SubjectView view) {
  view.playing = 0;
  view.may_switch = true;
  while (true) {
    subject.show(view);
    const SubjectAction action = wait_for_action(subject);
    if (action.kind == Kind::answer) return;
    view.playing = action.slot;
    view.may_answer = true;  // once a second slot was felt
  }
}

void sequence_trial(ServedSubject& subject, SubjectView view) {
  for (std::size_t slot = 0; slot < view.labels.size(); ++slot) {
    view.playing = slot;
    subject.show(view);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
  }
  view.playing.reset();
  view.may_answer = true;
  subject.show(view);
  wait_for_action(subject);
}

void take_a_break(ServedSubject& subject) {
  SubjectView view = text_view(SessionStage::pause, "");
  view.wait_s = 0.6;
  view.may_go_on = false;
  view.trial = 2;
  subject.show(view);
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  view.wait_s = 0.0;
  view.may_go_on = true;
  show_text(subject, view);
}

}  // namespace

int main() {
  ServedSubject subject;
  std::cout << subject.url() << std::endl;
  // To be read as it stands, with all its signs.
  show_text(subject, text_view(SessionStage::welcome, "You will feel tissues, <b>two</b> &amp; two."));
  show_text(subject,
            text_view(SessionStage::consent,
                      "You take part of your own will and may stop at any time, without giving a reason.\n\n"
                      "Your answers are stored under a code, without your name."));
  show_text(subject,
            text_view(SessionStage::instructions,
                      "Close the scissors slowly. Switch between A, B and X as often as you like.\n\n"
                      "Then say which of A and B is the same as X."));
  SubjectView abx = trial_view(1, {"A", "B", "X"}, 2, "Which of A and B is the same as X?");
  abx.practice = true;
  free_trial(subject, abx);
  SubjectView feedback = text_view(SessionStage::feedback, "It was B.");
  feedback.trial = 1;
  feedback.practice = true;
  show_text(subject, feedback);
  free_trial(subject, trial_view(2, {"A", "B"}, 2, "Which felt more like cutting liver?"));
  take_a_break(subject);
  sequence_trial(subject, trial_view(3, {"1", "2", "3"}, 3, "Which of the three was the odd one?"));
  SubjectView last = text_view(SessionStage::finished, "");
  last.may_go_on = false;
  subject.show(last);
}
