#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "subject/subject.h"

namespace kerf::bench {

// What every screen of a subject says, in the words of its texts, so that terminal and page say the same. No
// sentence differs in form from slot to slot.

[[nodiscard]] std::string_view name_of(SessionStage stage) noexcept;  ///< "consent", "trial"
/// The one heading of a screen: the question of a trial, or what the stage is.
[[nodiscard]] std::string heading(const SubjectView& view);
/// What is to be read below the heading; empty where the heading says it all.
[[nodiscard]] std::string text_below(const SubjectView& view);
/// "Trial 5 of 24", "Practice trial 1 of 24"; empty outside of trials.
[[nodiscard]] std::string progress(const SubjectView& view);
/// "You feel A now.", "Nothing plays now."; empty outside of trials.
[[nodiscard]] std::string what_plays(const SubjectView& view);
/// "A, B or X": the first so many labels.
[[nodiscard]] std::string label_list(const SubjectView& view, std::size_t count);

/// The answers: "A or B", "1 (same) or 2 (different)".
[[nodiscard]] std::string answer_list(const SubjectView& view);

}  // namespace kerf::bench
