#include "files/for_terminal.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
};

/// The character that a text begins with; none if that is no UTF-8.
std::optional<Character> first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return Character{lead, 1};
  const std::size_t bytes = lead >= 0xC2 && lead < 0xE0   ? 2
                            : lead >= 0xE0 && lead < 0xF0 ? 3
                            : lead >= 0xF0 && lead < 0xF5 ? 4
                                                          : 0;
  if (bytes == 0 || bytes > text.size()) return std::nullopt;
  char32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return std::nullopt;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  return Character{code, bytes};
}

constexpr bool steers(char32_t code) noexcept {
  return (code < 0x20 && code != U'\n' && code != U'\t') || (code >= 0x7F && code < 0xA0) ||
         (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

/// Takes the next character off `rest` and puts it to `shown` as it may be seen.
void show_next(std::string& shown, std::string_view& rest, std::string_view before_number) {
  const auto character = first_of(rest);
  const std::size_t bytes = character ? character->bytes : 1;
  if (!character) {
    shown += "\uFFFD";
  } else if (steers(character->code)) {
    shown += fmt::format("{}{:04x}", before_number, static_cast<unsigned>(character->code));
  } else {
    shown += rest.substr(0, bytes);
  }
  rest.remove_prefix(bytes);
}

constexpr bool is_plain(char c) noexcept { return c >= 0x20 && c < 0x7F && c != '\\'; }

/// Whether JSON goes on with the number of a character that steers, "\u001b".
bool begins_with_steering_number(std::string_view json) {
  constexpr std::size_t length = 6;
  unsigned code = 0;
  if (!json.starts_with("\\u") || json.size() < length) return false;
  const char* const end = json.data() + length;
  return std::from_chars(json.data() + 2, end, code, 16).ptr == end && steers(code);
}

}  // namespace

std::string for_terminal(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) show_next(shown, text, "\\u");
  return shown;
}

std::string json_for_page(std::string_view json) {
  std::string shown;
  shown.reserve(json.size());
  while (!json.empty()) {
    const auto end = std::find_if_not(json.begin(), json.end(), is_plain);
    const auto plain = static_cast<std::size_t>(end - json.begin());
    shown += json.substr(0, plain);  // nearly all of it, at once
    json.remove_prefix(plain);
    if (json.empty()) break;
    if (json.front() != '\\' || json.size() < 2) {
      show_next(shown, json, "\\\\u");
      continue;
    }
    if (begins_with_steering_number(json)) shown += '\\';
    shown += json.substr(0, 2);
    json.remove_prefix(2);
  }
  return shown;
}

}  // namespace kerf::bench
