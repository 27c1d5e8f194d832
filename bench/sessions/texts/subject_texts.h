#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::bench {

/// Every text that a participant reads and that no protocol says, in the order of texts.toml.
inline constexpr auto text_names = std::to_array<std::string_view>({
    "language",
    "language_name",
    "list_more",
    "list_or",
    "numbered_answer",
    "number_above_zero",
    "number_on_line",
    "number_in_steps",
    "question_of_second",
    "tlx_mental_demand",
    "tlx_physical_demand",
    "tlx_temporal_demand",
    "tlx_performance",
    "tlx_effort",
    "tlx_frustration",
    "tlx_very_low",
    "tlx_very_high",
    "tlx_perfect",
    "tlx_failure",
    "quoted",
    "title",
    "question_abx",
    "question_odd",
    "question_same_different",
    "answer_same",
    "answer_different",
    "answer_no",
    "answer_yes",
    "answer_with_confidence",
    "confidence_guessing",
    "confidence_fairly_sure",
    "confidence_sure",
    "heading_welcome",
    "heading_consent",
    "heading_instructions",
    "heading_trial",
    "heading_feedback",
    "heading_pause",
    "heading_finished",
    "heading_ready",
    "heading_questionnaire",
    "goes_on_one",
    "goes_on_other",
    "ready_key",
    "ready_tool",
    "ready_soon",
    "pause_rest",
    "pause_wait",
    "pause_length",
    "may_go_on",
    "finished_thanks",
    "finished_last",
    "finished_for_now",
    "feedback_right",
    "feedback_wrong",
    "trial_of",
    "question_of",
    "trial_of_about",
    "trial_of_at_most",
    "practice_of",
    "practice_of_about",
    "practice_of_at_most",
    "plays",
    "plays_nothing",
    "may_answer",
    "refused_now",
    "refused_late",
    "refused_decline",
    "refused_go_on",
    "refused_break",
    "refused_feel",
    "refused_sequence",
    "refused_answer",
    "refused_no_answer",
    "refused_still_playing",
    "refused_unexplored",
    "refused_unfelt",
    "refused_slip",
    "refused_noise",
    "time_is_over",
    "not_stored",
    "void_unexplored",
    "void_off_target",
    "keys_feel",
    "keys_which",
    "keys_answer",
    "keys_number",
    "hint_number",
    "keys_slip",
    "keys_stop",
    "keys_really_stop",
    "keys_consent",
    "keys_go_on",
    "hint_not_yet",
    "hint_no_answer_yet",
    "hint_time_to_feel",
    "hint_answers",
    "page_more",
    "page_last",
    "commands",
    "commands_more",
    "command_unknown",
    "command_play",
    "command_answer",
    "command_go_on",
    "command_agree",
    "command_decline",
    "command_slip",
    "command_quit",
    "page_title",
    "page_wait",
    "page_guide_name",
    "page_follow_ring",
    "page_follow_ring_alone",
    "page_follow_beat",
    "page_feel_name",
    "page_answer_name",
    "page_feel",
    "page_answer",
    "page_continue",
    "page_agree",
    "page_disagree",
    "page_slip",
    "page_stop",
    "page_really_stop",
    "page_stop_no",
    "page_stop_yes",
    "page_keys_feel",
    "page_keys_answer",
    "page_keys_number",
    "page_keys_line",
    "page_number",
    "page_line",
    "page_give",
    "page_number_cannot_be",
    "page_keys_go_on",
    "page_failed",
    "page_not_arrived",
    "page_connection_lost",
    "page_of_another_session",
    "page_wrong_address",
    "page_needs_script",
    "noise_name",
    "noise_ask",
    "noise_hear",
    "noise_loudness",
    "noise_keep",
});

/// The name of a text; one that there is not does not compile.
class TextName {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): so that a name is written as a literal
  consteval TextName(const char* name) : index_(index_of(name)) {}
  [[nodiscard]] constexpr std::size_t index() const noexcept { return index_; }

 private:
  static constexpr std::size_t index_of(std::string_view name) {
    for (std::size_t i = 0; i < text_names.size(); ++i) {
      if (text_names[i] == name) return i;
    }
    throw std::logic_error("there is no text of that name");
  }
  std::size_t index_;
};

/// The value of a placeholder: {"trial", "5"} for "{trial}".
struct TextValue {
  std::string_view placeholder;
  std::string value;
};

/// What a participant reads, in one language.
class SubjectTexts {
 public:
  /// All of them, in the order of `text_names`.
  explicit SubjectTexts(std::array<std::string, text_names.size()> texts) : texts_(std::move(texts)) {}

  [[nodiscard]] const std::string& operator()(TextName name) const noexcept { return texts_[name.index()]; }
  /// With the placeholders filled; those without a value stay.
  [[nodiscard]] std::string operator()(TextName name, std::initializer_list<TextValue> values) const;
  /// "A", "A or B", "A, B or X"
  [[nodiscard]] std::string list(const std::vector<std::string>& words) const;
  /// BCP 47: "en-GB".
  [[nodiscard]] const std::string& language() const noexcept { return (*this)("language"); }
  [[nodiscard]] const std::array<std::string, text_names.size()>& all() const noexcept { return texts_; }

  friend bool operator==(const SubjectTexts&, const SubjectTexts&) = default;

 private:
  std::array<std::string, text_names.size()> texts_;
};

/// The placeholders of a text, in their order. @throws std::invalid_argument: a brace is alone, or what is
/// between two is no name of a-z and _.
[[nodiscard]] std::vector<std::string> placeholders_of(std::string_view text);

/// Languages that come with the program, as a protocol calls them.
inline constexpr std::array<std::string_view, 2> shipped_languages{"en", "de"};

/// @throws std::invalid_argument: no such language.
[[nodiscard]] std::shared_ptr<const SubjectTexts> shipped_texts(std::string_view language);
[[nodiscard]] std::shared_ptr<const SubjectTexts> english_texts();

/// A language of one's own: `name = "text"` for each name, and no other, each with the placeholders of the
/// English text. @throws std::invalid_argument with file and line, of the first that is missing, unknown, or
/// without a placeholder.
[[nodiscard]] std::shared_ptr<const SubjectTexts> parse_texts(const std::string& toml,
                                                              const std::string& file);

/// As parse_texts() reads it.
[[nodiscard]] std::string to_toml(const SubjectTexts& texts);

/// Texts that were kept under their names, by whatever version: one that is missing, or that has not the
/// placeholders of today, is taken from those that come with the program in that language, or in English.
[[nodiscard]] std::shared_ptr<const SubjectTexts> kept_texts(const std::map<std::string, std::string>& kept);

}  // namespace kerf::bench
