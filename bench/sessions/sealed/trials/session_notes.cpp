#include "sealed/trials/session_notes.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {

std::vector<SessionNote> notes_of(const schema::Session& session) {
  std::vector<SessionNote> notes;
  for (const schema::SessionEntry& entry : session.entries) {
    if (entry.kind == "note") notes.push_back({.time = entry.time, .text = entry.text});
  }
  return notes;
}

std::string note_text(std::string_view given) {
  const std::size_t first = given.find_first_not_of(' ');
  if (first == std::string_view::npos)
    throw std::invalid_argument("the note is empty; expected one line of text");
  const std::string text(given.substr(first, given.find_last_not_of(' ') - first + 1));
  if (text.size() > longest_note)
    throw std::invalid_argument(
        fmt::format("the note has {} bytes, expected at most {}; make two of it", text.size(), longest_note));
  if (std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }))
    throw std::invalid_argument("the note has a line break or another control character; expected one line");
  return text;
}

}  // namespace kerf::bench
