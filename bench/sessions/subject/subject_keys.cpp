#include "subject/subject_keys.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

using Kind = SubjectAction::Kind;

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

}  // namespace

std::optional<std::size_t> slot_of(const SubjectView& view, std::string_view label) {
  for (std::size_t slot = 0; slot < view.labels.size(); ++slot) {
    if (is_same_word(view.labels[slot], label)) return slot;
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(label.data(), label.data() + label.size(), number);
  const bool counts = error == std::errc{} && end == label.data() + label.size();
  if (!counts || number < 1 || number > view.labels.size()) return std::nullopt;
  return number - 1;
}

std::optional<SubjectAction> command_of(const SubjectView& view, std::string_view line) {
  const std::string words = in_plain_words(line);
  if (words == "go on") return SubjectAction{.kind = Kind::go_on};
  if (words == "agree" && view.stage == SessionStage::consent) return SubjectAction{.kind = Kind::go_on};
  if (words == "decline") return SubjectAction{.kind = Kind::decline};
  if (words == "quit") return SubjectAction{.kind = Kind::quit};
  const std::size_t blank = words.find(' ');
  if (blank == std::string::npos) return std::nullopt;
  const std::optional<std::size_t> slot = slot_of(view, std::string_view(words).substr(blank + 1));
  if (!slot) return std::nullopt;
  if (words.starts_with("play ")) return SubjectAction{.kind = Kind::play, .slot = *slot};
  if (words.starts_with("answer ")) return SubjectAction{.kind = Kind::answer, .slot = *slot};
  return std::nullopt;
}

void SubjectKeys::show(const SubjectView& view) {
  manner_.see(view_, view);
  if (is_new_screen(view_, view) || !view.may_answer) {
    if (waits_ == Waits::for_the_answer) waits_ = Waits::for_anything;
  }
  if (is_new_screen(view_, view)) waits_ = Waits::for_anything;
  view_ = view;
  hint_.clear();
}

std::optional<SubjectAction> SubjectKeys::press(char key) {
  hint_.clear();
  key = lower(key);
  if (waits_ == Waits::for_yes) {
    waits_ = Waits::for_anything;
    if (key == 'y') return SubjectAction{.kind = Kind::quit};
    return std::nullopt;
  }
  if (key == 'q' || key == '\x04') {  // Ctrl-D is the end of the input where it is read by lines
    waits_ = Waits::for_yes;
    return std::nullopt;
  }
  if (view_.stage == SessionStage::trial) return press_in_trial(key);
  if (view_.stage == SessionStage::consent && key == 'd') return SubjectAction{.kind = Kind::decline};
  const bool goes_on = key == ' ' || (view_.stage != SessionStage::consent && (key == '\r' || key == '\n'));
  if (goes_on && view_.may_go_on) return SubjectAction{.kind = Kind::go_on};
  if (goes_on) hint_ = "Not yet.";
  return std::nullopt;
}

std::optional<SubjectAction> SubjectKeys::press_in_trial(char key) {
  if (key == escape) {
    waits_ = Waits::for_anything;
  } else if (key == '\r' || key == '\n') {
    if (manner_.is_free() && view_.may_answer) {
      waits_ = Waits::for_the_answer;
    } else if (manner_.is_free()) {
      hint_ = "You cannot answer yet.";
    }
  } else if (const auto slot = slot_of(view_, std::string_view(&key, 1))) {
    return play_or_answer(*slot);
  }
  return std::nullopt;
}

std::optional<SubjectAction> SubjectKeys::play_or_answer(std::size_t slot) {
  if (waits_ == Waits::for_the_answer || !manner_.is_free()) return answer(slot);
  if (view_.may_switch) return SubjectAction{.kind = Kind::play, .slot = slot};
  hint_ = view_.may_answer ? "The time to feel is over. Press Enter to answer." : "Not now.";
  return std::nullopt;
}

std::optional<SubjectAction> SubjectKeys::answer(std::size_t slot) {
  if (slot >= view_.answers) {
    hint_ = fmt::format("The answer is one of {}.", label_list(view_, view_.answers));
  } else if (!view_.may_answer) {
    hint_ = "You cannot answer yet.";
  } else {
    waits_ = Waits::for_anything;
    return SubjectAction{.kind = Kind::answer, .slot = slot};
  }
  return std::nullopt;
}

std::string SubjectKeys::what_keys_do() const {
  if (waits_ == Waits::for_yes) return "Stop the session? Y: yes. Any other key: no.";
  const std::string answers = label_list(view_, view_.answers);
  if (waits_ == Waits::for_the_answer) return fmt::format("Answer: which? {}. Escape: not yet.", answers);
  if (view_.stage == SessionStage::trial && manner_.is_free()) {
    return fmt::format("{}: feel it. Enter: answer. Q: stop.", label_list(view_, view_.labels.size()));
  }
  if (view_.stage == SessionStage::trial) {
    return view_.may_answer ? fmt::format("{}: your answer. Q: stop.", answers) : "Q: stop.";
  }
  if (view_.stage == SessionStage::consent) return "Space: I agree. D: I do not agree. Q: stop.";
  if (view_.stage == SessionStage::finished) return {};
  return view_.may_go_on ? "Space: go on. Q: stop." : "Q: stop.";
}

}  // namespace kerf::bench
