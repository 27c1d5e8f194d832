#include "subject/subject_keys.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>

#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

using Kind = SubjectAction::Kind;

// The same in every language: a text names the key that it is about by {key}.
constexpr char yes_key = 'y';
constexpr char stop_key = 'q';
constexpr char decline_key = 'd';
constexpr char slip_key = 's';

char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_same_word(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

/// The line's words with one blank between them.
std::string in_plain_words(std::string_view line) {
  std::string words;
  for (const char c : line) {
    const bool blank = c == ' ' || c == '\t' || c == '\r';
    if (!blank) words += lower(c);
    if (blank && !words.empty() && words.back() != ' ') words += ' ';
  }
  if (words.ends_with(' ')) words.pop_back();
  return words;
}

/// What a command is called: in the subject's language, and in English, which scripts write.
std::array<std::string, 2> names_of(const SubjectView& view, TextName command) {
  return {in_plain_words((*view.texts)(command)), in_plain_words((*english_texts())(command))};
}

bool is_command(const SubjectView& view, TextName command, std::string_view words) {
  return std::ranges::count(names_of(view, command), words) > 0;
}

std::optional<std::string_view> after_command(const SubjectView& view, TextName command,
                                              std::string_view words) {
  for (const std::string& name : names_of(view, command)) {
    if (words.starts_with(name + ' ')) return words.substr(name.size() + 1);
  }
  return std::nullopt;
}

std::optional<std::size_t> place_of_label(const std::vector<std::string>& labels, std::string_view label) {
  for (std::size_t place = 0; place < labels.size(); ++place) {
    if (is_same_word(labels[place], label)) return place;
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(label.data(), label.data() + label.size(), number);
  const bool counts = error == std::errc{} && end == label.data() + label.size();
  if (!counts || number < 1 || number > labels.size()) return std::nullopt;
  return number - 1;
}

std::string on_keyboard(char key) { return {static_cast<char>(key - 'a' + 'A')}; }

/// With a blank between those that say something.
std::string joined(std::initializer_list<std::string> sentences) {
  std::string text;
  for (const std::string& one : sentences) {
    if (!one.empty()) text += text.empty() ? one : ' ' + one;
  }
  return text;
}

}  // namespace

std::optional<std::size_t> slot_of(const SubjectView& view, std::string_view label) {
  return place_of_label(view.labels, label);
}

std::optional<std::size_t> answer_of(const SubjectView& view, std::string_view label) {
  return place_of_label(view.answer_labels.empty() ? view.labels : view.answer_labels, label);
}

std::optional<double> number_in(std::string_view text) {
  std::string plain(text);
  std::ranges::replace(plain, ',', '.');
  double number = 0.0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), number);
  if (error != std::errc{} || end != plain.data() + plain.size() || !std::isfinite(number))
    return std::nullopt;
  return number;
}

std::optional<SubjectAction> command_of(const SubjectView& view, std::string_view line) {
  const std::string words = in_plain_words(line);
  if (is_command(view, "command_go_on", words)) return SubjectAction{.kind = Kind::go_on};
  if (is_command(view, "command_agree", words) && view.stage == SessionStage::consent)
    return SubjectAction{.kind = Kind::go_on};
  if (is_command(view, "command_decline", words)) return SubjectAction{.kind = Kind::decline};
  if (is_command(view, "command_slip", words)) return SubjectAction{.kind = Kind::slip};
  if (is_command(view, "command_quit", words)) return SubjectAction{.kind = Kind::quit};
  if (const auto label = after_command(view, "command_answer", words)) {
    if (view.number) {
      if (const auto number = number_in(*label))
        return SubjectAction{.kind = Kind::answer, .number = *number};
    } else if (const auto slot = answer_of(view, *label)) {
      return SubjectAction{.kind = Kind::answer, .slot = *slot};
    }
  }
  if (const auto label = after_command(view, "command_play", words)) {
    if (const auto slot = slot_of(view, *label)) return SubjectAction{.kind = Kind::play, .slot = *slot};
  }
  return std::nullopt;
}

void SubjectKeys::show(const SubjectView& view) {
  manner_.see(view_, view);
  if (is_new_screen(view_, view) || !view.may_answer) {
    if (waits_ == Waits::for_the_answer) waits_ = Waits::for_anything;
  }
  if (is_new_screen(view_, view)) {
    waits_ = Waits::for_anything;
    typed_.clear();
  }
  view_ = view;
  hint_.clear();
}

std::optional<SubjectAction> SubjectKeys::press(char key) {
  hint_.clear();
  key = lower(key);
  if (waits_ == Waits::for_yes) {
    waits_ = Waits::for_anything;
    if (key == yes_key) return SubjectAction{.kind = Kind::quit};
    return std::nullopt;
  }
  if (key == stop_key || key == '\x04') {  // Ctrl-D is the end of the input where it is read by lines
    waits_ = Waits::for_yes;
    return std::nullopt;
  }
  if (view_.stage == SessionStage::trial) return press_in_trial(key);
  if (view_.number) return press_of_number(key);
  if (view_.stage == SessionStage::consent && key == decline_key) return SubjectAction{.kind = Kind::decline};
  const bool goes_on = key == ' ' || (view_.stage != SessionStage::consent && (key == '\r' || key == '\n'));
  if (goes_on && view_.may_go_on) return SubjectAction{.kind = Kind::go_on};
  if (goes_on) hint_ = (*view_.texts)("hint_not_yet");
  return std::nullopt;
}

std::optional<SubjectAction> SubjectKeys::press_of_number(char key) {
  constexpr std::size_t longest_number = 12;
  constexpr char backspace = '\b';
  constexpr char rubout = '\x7f';
  if (key == 's' && view_.may_slip) return SubjectAction{.kind = Kind::slip};
  if (key == escape) typed_.clear();
  if ((key == backspace || key == rubout) && !typed_.empty()) typed_.pop_back();
  const bool is_digit = (key >= '0' && key <= '9') || key == '.' || key == ',';
  const bool gives = key == '\r' || key == '\n';
  if (!is_digit && !gives) return std::nullopt;
  if (!view_.may_answer) {
    hint_ = (*view_.texts)("hint_no_answer_yet");
    return std::nullopt;
  }
  if (is_digit && typed_.size() < longest_number) typed_ += key;
  if (!gives) return std::nullopt;
  const std::optional<double> number = number_in(typed_);
  typed_.clear();
  if (number && view_.number->takes(*number)) return SubjectAction{.kind = Kind::answer, .number = *number};
  hint_ = (*view_.texts)("hint_number", {{"answers", answer_list(view_)}});
  return std::nullopt;
}

std::optional<SubjectAction> SubjectKeys::press_in_trial(char key) {
  if (view_.number) return press_of_number(key);
  if (key == escape) {
    waits_ = Waits::for_anything;
  } else if (key == '\r' || key == '\n') {
    if (manner_.is_free() && view_.may_answer) {
      waits_ = Waits::for_the_answer;
    } else if (manner_.is_free()) {
      hint_ = (*view_.texts)("hint_no_answer_yet");
    }
  } else if (key == slip_key && view_.may_slip) {
    waits_ = Waits::for_anything;
    return SubjectAction{.kind = Kind::slip};
  } else if (waits_ == Waits::for_the_answer || !manner_.is_free()) {
    if (const auto chosen = answer_of(view_, std::string_view(&key, 1))) return answer(*chosen);
  } else if (const auto slot = slot_of(view_, std::string_view(&key, 1))) {
    return play(*slot);
  }
  return std::nullopt;
}

std::optional<SubjectAction> SubjectKeys::play(std::size_t slot) {
  if (view_.may_switch) return SubjectAction{.kind = Kind::play, .slot = slot};
  hint_ = (*view_.texts)(view_.may_answer ? TextName("hint_time_to_feel") : TextName("refused_now"));
  return std::nullopt;
}

std::optional<SubjectAction> SubjectKeys::answer(std::size_t slot) {
  if (slot >= view_.answers) {
    hint_ = (*view_.texts)("hint_answers", {{"answers", answer_list(view_)}});
  } else if (!view_.may_answer) {
    hint_ = (*view_.texts)("hint_no_answer_yet");
  } else {
    waits_ = Waits::for_anything;
    return SubjectAction{.kind = Kind::answer, .slot = slot};
  }
  return std::nullopt;
}

std::string SubjectKeys::what_keys_do() const {
  const SubjectTexts& texts = *view_.texts;
  const auto of_key = [&](TextName name, char key) { return texts(name, {{"key", on_keyboard(key)}}); };
  if (waits_ == Waits::for_yes) return of_key("keys_really_stop", yes_key);
  const std::string answers = answer_list(view_);
  if (waits_ == Waits::for_the_answer) return texts("keys_which", {{"answers", answers}});
  const std::string stop = of_key("keys_stop", stop_key);
  if (view_.stage == SessionStage::trial || view_.number) {
    const std::string slip = view_.may_slip ? of_key("keys_slip", slip_key) : std::string();
    if (view_.stage == SessionStage::trial && manner_.is_free())
      return joined({texts("keys_feel", {{"labels", label_list(view_, view_.labels.size())}}), slip, stop});
    if (view_.may_answer && view_.number)
      return joined({texts("keys_number", {{"answers", answers}, {"typed", typed_}}), slip, stop});
    return joined({view_.may_answer ? texts("keys_answer", {{"answers", answers}}) : "", slip, stop});
  }
  if (view_.stage == SessionStage::consent) return joined({of_key("keys_consent", decline_key), stop});
  if (view_.stage == SessionStage::finished) return {};
  return joined({view_.may_go_on ? texts("keys_go_on") : "", stop});
}

}  // namespace kerf::bench
