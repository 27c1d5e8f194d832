// Serves the subject's page with a session that is a script: every stage, a trial of either presentation,
// numbers for answers; with the argument "de" one in German, of the longest texts; with "target" or
// "metronome" a trial that is led, by a loop that is played; with "questionnaire", and "de" after it, one.
// Its address goes to standard output, and so does every action. For page_browser_test.py and
// german_page_test.py, and to look at: run it and open the address.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>
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
      std::cout << "action " << static_cast<int>(action->kind) << ' ' << action->slot;
      if (std::isfinite(action->number)) std::cout << ' ' << action->number;
      std::cout << std::endl;
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

SubjectView in_german(SubjectView view) {
  view.study = "Gewebe schneiden";
  view.texts = shipped_texts("de");
  return view;
}

void run_in_german(ServedSubject& subject) {
  const SubjectTexts& texts = *shipped_texts("de");
  subject.page().use_noise(MaskingNoise::pink, std::nullopt, [](double) {});
  show_text(subject, in_german(text_view(SessionStage::welcome, "")));
  show_text(subject,
            in_german(text_view(
                SessionStage::consent,
                "Ihre Teilnahme ist freiwillig. Sie können jederzeit ohne Angabe von Gründen "
                "abbrechen.\n\nIhre Antworten werden unter einem Code gespeichert, ohne Ihren Namen.")));
  SubjectView abx = in_german(trial_view(1, {"A", "B", "X"}, 2, texts("question_abx")));
  abx.practice = true;
  abx.may_be_more = true;
  abx.may_slip = true;
  abx.notice = texts("refused_unexplored");
  free_trial(subject, abx);
  SubjectView sure = in_german(trial_view(12, {"A"}, 6, "War es die steifere der beiden Proben?"));
  for (const TextName answer : {TextName("answer_no"), TextName("answer_yes")}) {
    for (const TextName confidence :
         {TextName("confidence_sure"), TextName("confidence_fairly_sure"), TextName("confidence_guessing")}) {
      sure.answer_labels.push_back(
          texts("answer_with_confidence", {{"answer", texts(answer)}, {"confidence", texts(confidence)}}));
    }
  }
  sure.may_be_more = true;
  sure.notice = texts("void_unexplored");
  sequence_trial(subject, sure);
  SubjectView pause = in_german(text_view(SessionStage::pause, ""));
  pause.may_go_on = false;
  pause.wait_s = 600.0;
  subject.show(pause);
  wait_for_action(subject);
}

/// A hand that follows 0.1 s later and not quite so far.
GuideLook played_look(const GuidedMotion& guide) {
  static const auto begun = std::chrono::steady_clock::now();
  const double time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  if (!guide.has_target()) return {.time_s = time_s};
  const double middle = 0.5 * (guide.from + guide.to);
  return {.time_s = time_s, .position = middle + 0.9 * (guide.at(time_s - 0.1).position - middle)};
}

int guided_session(const std::string& kind) {
  GuidedMotion guide{.kind = GuideKind::strokes, .from = 0.5, .to = 0.1, .stroke_s = 0.8, .pause_s = 0.25};
  if (kind == "metronome") guide = {.kind = GuideKind::metronome, .beat_s = 0.5};
  ServedSubject subject;
  subject.page().use_guide(guide, [guide] { return played_look(guide); });
  std::cout << subject.url() << std::endl;
  show_text(subject, text_view(SessionStage::instructions, "Follow the target."));
  SubjectView ready = text_view(SessionStage::ready, "");
  ready.trial = 1;
  ready.guided = true;
  show_text(subject, ready);
  SubjectView trial = trial_view(1, {"A", "B"}, 2, "Which felt more like cutting liver?");
  trial.guided = true;
  free_trial(subject, trial);
  SubjectView last = text_view(SessionStage::finished, "");
  last.may_go_on = false;
  subject.show(last);
  return 0;
}

SubjectView item_view(std::size_t number, const std::shared_ptr<const SubjectTexts>& texts,
                      const std::string& question, const std::string& low, const std::string& high) {
  return {.stage = SessionStage::questionnaire,
          .study = study,
          .text = question,
          .number = SubjectView::AskedNumber{.lower = 0.0, .upper = 100.0, .step = 5.0, .ends = {low, high}},
          .may_answer = true,
          .trial = number,
          .at_most = 3,
          .texts = texts};
}

/// Between a trial and the end, as after a block: the second item has the ends of none before it, the third
/// ends as long as a protocol may have them.
int questionnaire_session(bool is_german) {
  const std::shared_ptr<const SubjectTexts> texts = shipped_texts(is_german ? "de" : "en");
  ServedSubject subject(0, texts);
  std::cout << subject.url() << std::endl;
  SubjectView trial = trial_view(1, {"A", "B"}, 2, (*texts)("question_abx"));
  trial.texts = texts;
  free_trial(subject, trial);
  show_text(subject, item_view(1, texts, (*texts)("tlx_mental_demand"), (*texts)("tlx_very_low"),
                               (*texts)("tlx_very_high")));
  show_text(subject, item_view(2, texts, (*texts)("tlx_performance"), (*texts)("tlx_perfect"),
                               (*texts)("tlx_failure")));
  show_text(
      subject,
      is_german
          ? item_view(3, texts,
                      "Wie sehr glich das, was Sie fühlten, dem Schneiden von Gewebe, wie Sie es aus "
                      "Ihrer täglichen Arbeit kennen?",
                      "überhaupt nicht wie wirkliches Gewebe", "ununterscheidbar von wirklichem Gewebe")
          : item_view(3, texts,
                      "How much was what you felt like the cutting of tissue that you know from your "
                      "daily work?",
                      "not at all like the tissue that I know", "not to be told from the tissue I know"));
  SubjectView last = text_view(SessionStage::finished, "");
  last.may_go_on = false;
  last.texts = texts;
  subject.show(last);
  return 0;
}

int serve(int count, char** arguments) {
  const std::string_view kind = count > 1 ? arguments[1] : "";
  if (kind == "target" || kind == "metronome") return guided_session(arguments[1]);
  if (kind == "questionnaire")
    return questionnaire_session(count > 2 && std::string_view(arguments[2]) == "de");
  const bool is_german = kind == "de";
  ServedSubject subject(0, shipped_texts(is_german ? "de" : "en"));
  std::cout << subject.url() << std::endl;
  if (is_german) run_in_german(subject);
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
  SubjectView magnitude = trial_view(4, {"1"}, 1, "How strong was it?");
  magnitude.number = {.lower = 1e-6, .upper = 1e9, .ends = {}};
  sequence_trial(subject, magnitude);
  SubjectView line = trial_view(5, {"1"}, 1, "How real was it?");
  line.number = {.lower = 0.0, .upper = 100.0, .ends = {"not at all", "exactly"}};
  sequence_trial(subject, line);
  SubjectView steps = trial_view(6, {"1"}, 5, "How real was it, in steps?");
  steps.answer_labels = {"not at all", "2", "3", "4", "exactly"};
  steps.in_steps = true;
  sequence_trial(subject, steps);
  SubjectView last = text_view(SessionStage::finished, "");
  last.may_go_on = false;
  subject.show(last);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    return serve(count, arguments);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
  }
}
