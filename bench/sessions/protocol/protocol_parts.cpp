#include "protocol/protocol_parts.h"

#include <algorithm>
#include <cmath>

namespace kerf::bench {
namespace {

constexpr std::size_t longest_name = 60;

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

std::size_t characters_in(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

const toml::node& node_or_table(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  return node != nullptr ? *node : table;
}

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

std::string read_name(const Place& place, const toml::table& table, std::string_view what) {
  std::string name = read_plain_text(place, table, "name");
  if (name.empty()) place.refuse(node_or_table(table, "name"), "{} needs a 'name'", what);
  if (characters_in(name) > longest_name || name.front() == ' ' || name.back() == ' ') {
    place.refuse(*table.get("name"),
                 "'{}' is no name for {}; expected at most {} characters, no space at the ends", name, what,
                 longest_name);
  }
  return name;
}

double read_plain_number(const Place& place, const toml::table& table, const PlainNumber& about) {
  const toml::node* node = table.get(about.key);
  if (node == nullptr) return about.standard;
  const double value = place.number(*node, fmt::format("'{}'", about.key));
  if (!(value >= about.lower && value <= about.upper)) {
    place.refuse(*node, "'{}' is {:g}, expected a number from {:g} to {:.10g}", about.key, value, about.lower,
                 about.upper);
  }
  return value;
}

std::size_t read_count(const Place& place, const toml::table& table, const PlainNumber& about) {
  const double value = read_plain_number(place, table, about);
  if (value != std::floor(value))
    place.refuse(*table.get(about.key), "'{}' is {:g}, expected a whole number", about.key, value);
  return static_cast<std::size_t>(value);
}

}  // namespace kerf::bench
