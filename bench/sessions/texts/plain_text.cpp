#include "texts/plain_text.h"

#include <algorithm>

namespace kerf::bench {
namespace {

/// The first control character of a text in UTF-8, C0, DEL or C1; 0 if there is none.
unsigned control_character(std::string_view text, bool lines) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte == '\n' && lines) continue;
    if (byte < 0x20 || byte == 0x7F) return byte == 0 ? 0xFFFD : byte;
    if (byte != 0xC2 || i + 1 == text.size()) continue;
    const auto next = static_cast<unsigned char>(text[i + 1]);
    if (next >= 0x80 && next < 0xA0) return next;
  }
  return 0;
}

}  // namespace

std::string read_plain_text(const Place& place, const toml::table& table, std::string_view key, bool lines) {
  std::string text = place.text(table, key, "");
  for (std::size_t at = text.find("\r\n"); at != std::string::npos; at = text.find("\r\n", at))
    text.erase(at, 1);
  if (const unsigned control = control_character(text, lines); control != 0) {
    place.refuse(*table.get(key), "'{}' has the control character U+{:04X} in it, expected plain text{}", key,
                 control, lines ? "" : " on one line");
  }
  return text;
}

std::size_t characters_in(std::string_view text) noexcept {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace kerf::bench
