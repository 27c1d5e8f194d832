#include "subject/subject_words.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace kerf::bench {

std::string_view name_of(SessionStage stage) noexcept {
  switch (stage) {
    case SessionStage::welcome:
      return "welcome";
    case SessionStage::consent:
      return "consent";
    case SessionStage::instructions:
      return "instructions";
    case SessionStage::trial:
      return "trial";
    case SessionStage::feedback:
      return "feedback";
    case SessionStage::pause:
      return "pause";
    case SessionStage::finished:
      return "finished";
    case SessionStage::ready:
      return "ready";
    case SessionStage::questionnaire:
      return "questionnaire";
  }
  return "unknown";
}

std::string heading(const SubjectView& view) {
  const SubjectTexts& texts = *view.texts;
  switch (view.stage) {
    case SessionStage::welcome:
      return texts("heading_welcome");
    case SessionStage::consent:
      return texts("heading_consent");
    case SessionStage::instructions:
      return texts("heading_instructions");
    case SessionStage::trial:
      return view.text.empty() ? texts("heading_trial") : view.text;
    case SessionStage::feedback:
      return texts("heading_feedback");
    case SessionStage::pause:
      return texts("heading_pause");
    case SessionStage::finished:
      return texts("heading_finished");
    case SessionStage::ready:
      return texts("heading_ready");
    case SessionStage::questionnaire:
      return texts("heading_questionnaire");
  }
  return {};
}

std::string text_below(const SubjectView& view) {
  if (view.stage == SessionStage::trial) return {};
  if (!view.text.empty()) return view.text;
  const SubjectTexts& texts = *view.texts;
  switch (view.stage) {
    case SessionStage::ready:
      if (view.may_go_on) return texts("ready_key");
      return view.tool_is_waited_for ? texts("ready_tool") : texts("ready_soon");
    case SessionStage::pause:
      return texts("pause_rest");
    case SessionStage::finished:
      return texts("finished_thanks");
    default:
      return {};
  }
}

std::string progress(const SubjectView& view) {
  if (view.trial == 0) return {};
  if (view.stage == SessionStage::questionnaire)
    return (*view.texts)("question_of",
                         {{"number", std::to_string(view.trial)}, {"count", std::to_string(view.at_most)}});
  const auto said = [&](TextName of, TextName of_about, TextName of_at_most) {
    const TextName name = view.may_be_more ? of_about : view.may_be_fewer ? of_at_most : of;
    return (*view.texts)(name,
                         {{"trial", std::to_string(view.trial)}, {"most", std::to_string(view.at_most)}});
  };
  return view.practice ? said("practice_of", "practice_of_about", "practice_of_at_most")
                       : said("trial_of", "trial_of_about", "trial_of_at_most");
}

std::string what_plays(const SubjectView& view) {
  if (view.stage != SessionStage::trial) return {};
  const SubjectTexts& texts = *view.texts;
  if (!view.playing || *view.playing >= view.labels.size()) return texts("plays_nothing");
  return texts("plays", {{"label", view.labels[*view.playing]}});
}

std::string answer_list(const SubjectView& view) {
  if (view.number && view.number->ends.size() == 2) {
    const std::string number =
        (*view.texts)("number_on_line", {{"lower", fmt::format("{:g}", view.number->lower)},
                                         {"low", view.number->ends[0]},
                                         {"upper", fmt::format("{:g}", view.number->upper)},
                                         {"high", view.number->ends[1]}});
    if (view.number->step == 0.0) return number;
    return (*view.texts)("number_in_steps",
                         {{"number", number}, {"step", fmt::format("{:g}", view.number->step)}});
  }
  if (view.number) return (*view.texts)("number_above_zero");
  if (view.answer_labels.empty()) return label_list(view, view.answers);
  std::vector<std::string> numbered;
  for (const std::string& label : view.answer_labels) {
    const std::string step = std::to_string(numbered.size() + 1);
    numbered.push_back(
        label == step ? step : (*view.texts)("numbered_answer", {{"number", step}, {"answer", label}}));
  }
  return view.texts->list(numbered);
}

std::string label_list(const SubjectView& view, std::size_t count) {
  const auto end = view.labels.begin() + static_cast<std::ptrdiff_t>(std::min(count, view.labels.size()));
  return view.texts->list({view.labels.begin(), end});
}

}  // namespace kerf::bench
