#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/session.h>

namespace kerf::bench {

inline constexpr std::size_t longest_note = 500;  ///< bytes

/// What the experimenter wrote of a session: an entry "note", for everybody to read.
struct SessionNote {
  std::string time;  ///< ISO 8601, UTC
  std::string text;
};
[[nodiscard]] std::vector<SessionNote> notes_of(const schema::Session& session);

/// The text without spaces around it. @throws std::invalid_argument: none, more than one line, a control
/// character, or longer than longest_note.
[[nodiscard]] std::string note_text(std::string_view given);

}  // namespace kerf::bench
