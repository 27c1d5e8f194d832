#include "import/text/named_column.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "files/trimmed.h"
#include "import/column_map.h"
#include "import/decimal.h"
#include "import/text/column_words.h"
#include "import/text/unit_words.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// What stands in square brackets is no unit if it says which of several a column is.
bool tells_columns_apart(std::string_view text) {
  constexpr std::array words{"x",   "y",   "z",    "max",   "min", "mean", "avg",
                             "rms", "abs", "left", "right", "eff", "std"};
  return is_number(text) || std::ranges::find(words, in_small_letters(trimmed(text))) != words.end();
}

bool is_letter_of_unit(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80 ||
         c == '%';
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// "mN" and not "10 mN", which may as well be what the sensor bears.
bool is_unit_alone(std::string_view text) {
  text = trimmed(text);
  return !text.empty() && is_letter_of_unit(text.front()) && is_known_unit(text);
}

/// Whether a number is one that values are multiplied by, and not the one of a sensor: 10 and more, or with a
/// fraction.
bool is_of_scale(std::string_view number) {
  double value = 0.0;
  const char* const end = number.data() + number.size();
  return parse_decimal(number.data(), end, '.', value) == end &&
         (value >= 10.0 || value != std::floor(value));
}

/// Where a heading says that its numbers are multiplied: "x10", "*10", "10x", "/10", "1e-3", "10^3"; npos if
/// it does not. Not "Fx10", "x2" or "marker_x10", which are names.
std::size_t find_factor(std::string_view text) {
  const auto at_or_blank = [&](std::size_t at) { return at < text.size() ? text[at] : ' '; };
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool begins = is_digit(text[at]) && (at == 0 || (!is_digit(text[at - 1]) && text[at - 1] != '.'));
    if (!begins) continue;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.", at), text.size());
    const std::string_view number = text.substr(at, end - at);
    const std::string_view before = trimmed(text.substr(0, at));
    const std::string_view behind = trimmed(text.substr(end));
    const char next = at_or_blank(end);
    const bool has_exponent =
        (next == 'e' || next == 'E') &&
        (is_digit(at_or_blank(end + 1)) || (at_or_blank(end + 1) == '-' && is_digit(at_or_blank(end + 2))));
    const bool ends_word = at > 0 && is_letter_of_unit(text[at - 1]);
    if (!ends_word &&
        (has_exponent || behind.starts_with('^') || behind.starts_with('*') || behind.starts_with("×")))
      return at;
    for (const std::string_view sign : {"*", "×", "/", "÷"}) {
      if (before.ends_with(sign) && before.size() > sign.size() &&
          !is_digit(before[before.size() - sign.size() - 1]))
        return before.size() - sign.size();
    }
    const auto is_times = [](char c) { return c == 'x' || c == 'X'; };
    if (!is_of_scale(number)) continue;
    if (is_times(at_or_blank(end)) && !is_letter_of_unit(at_or_blank(end + 1))) return at;
    if (before.size() < 2 || !is_times(before.back())) continue;
    const char first = before[before.size() - 2];
    if (!is_letter_of_unit(first) && !is_digit(first) && first != '_') return before.size() - 1;
  }
  return std::string_view::npos;
}

/// A unit in a heading, and where it stands.
struct FoundUnit {
  std::string unit;
  bool is_known = true;
  std::size_t begin = std::string_view::npos;  ///< npos: there is none
};

/// The channel whose units a name asks for; empty if it says none.
std::string_view channel_said_by(std::string_view name) {
  const ColumnWords words = words_of(name);
  if (words.known != nullptr) return words.known->channel;
  const std::vector<std::string> all = split_into_words(name);
  const bool is_axis = !all.empty() && (all.front() == "fx" || all.front() == "fy");
  return is_axis ? "force" : "";
}

bool is_unit_of(std::string_view unit, std::string_view channel) {
  const auto kinds = kinds_of(channel);
  const std::string si = parse_unit(unit).si;
  return std::ranges::find(kinds, si) != kinds.end() || (channel == "force" && si == "kg");
}

/// "MN" of a force, "MS" of a time: a unit but for its capitals, on which its factor hangs.
bool is_unit_in_other_case(std::string_view word, std::string_view channel) {
  if (word.size() < 2 || is_known_unit(word)) return false;
  const auto is_it = [&](std::string_view symbol) {
    return in_small_letters(symbol) == in_small_letters(word);
  };
  return std::ranges::any_of(
      kinds_of(channel), [&](std::string_view kind) { return std::ranges::any_of(symbols_of(kind), is_it); });
}

/// The words of a heading, where they stand in it. Blanks and most signs part them.
std::vector<std::string_view> words_in(std::string_view text) {
  const auto is_of_word = [&](std::size_t at) {
    const char c = text[at];
    const bool in_number = c == '.' && at > 0 && is_digit(text[at - 1]);
    return is_letter_of_unit(c) || is_digit(c) || in_number || c == '^' || c == '*' || c == '/';
  };
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_of_word(end)) ++end;
    if (end > at) words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

/// Units that are words or names as well: they are units only where they fit what the name says.
bool may_be_no_unit(std::string_view word, bool behind_underscore) {
  constexpr std::array always{"in", "h", "min", "rev"};
  constexpr std::array behind_blank{"ft", "bar", "lb", "oz"};
  if (std::ranges::find(always, word) != always.end()) return true;
  if (behind_underscore) return false;
  return (word.size() < 2 && word != "V") || std::ranges::find(behind_blank, word) != behind_blank.end();
}

/// The unit among the words of a text: "Force mN", "Fz, N", "t_s", "mN Force", "pos_mm_min". One that fits
/// what the name says stands anywhere, another one at the end.
FoundUnit unit_among_words(std::string_view text, std::string_view channel) {
  constexpr std::array statistics{"max", "mean", "avg", "median", "std", "stddev", "rms", "min"};
  constexpr std::array raw{"raw", "counts", "adc", "lsb", "ticks"};
  std::vector<std::string_view> words = words_in(text);
  const auto found = [&](std::string_view from, std::string unit, bool is_known) {
    return FoundUnit{.unit = std::move(unit),
                     .is_known = is_known,
                     .begin = static_cast<std::size_t>(from.data() - text.data())};
  };
  const auto fits = [&](std::string_view word) {
    return is_unit_alone(word) && word != "rev" && is_unit_of(word, channel);
  };
  const auto is_statistic = [&] {
    const std::string last = in_small_letters(words.back());
    return std::ranges::find(statistics, last) != statistics.end() &&
           (last != "min" || channel != "time" || std::ranges::any_of(words.begin(), words.end() - 1, fits));
  };
  while (words.size() > 1 && is_statistic()) words.pop_back();
  for (std::size_t i = words.size(); i-- > 0;) {
    const std::string_view word = words[i];
    const bool is_last = i + 1 == words.size();
    const bool behind_underscore = word.data() > text.data() && *(word.data() - 1) == '_';
    if (is_last && std::ranges::find(raw, in_small_letters(word)) != raw.end() && i > 0)
      return found(word, std::string(word), false);
    if (is_last && is_unit_in_other_case(word, channel)) return found(word, std::string(word), false);
    if (!is_unit_alone(word) || (word == "in" && !is_last)) continue;
    const std::string_view before = i > 0 ? words[i - 1] : std::string_view();
    const std::string pair = fmt::format("{} {}", before, word);
    if (i > 0 && is_unit_alone(pair)) return found(before, pair, true);  // "N-m"
    if (!fits(word) && (!is_last || i == 0 || may_be_no_unit(word, behind_underscore))) continue;
    // Programmers write N·m so, too.
    if (word == "nm" && !fits(word)) return found(word, "nm", false);
    if (before == "per" && i > 1 && is_unit_alone(words[i - 2]))
      return found(words[i - 2], fmt::format("{}/{}", words[i - 2], word), true);
    // "mm_s", "N mm": by, or times? "10 mN": a factor, or what the sensor bears?
    const bool is_pair = i > 1 && is_unit_alone(before);
    if (is_pair || is_of_scale(before))
      return found(before, std::string(text.substr(static_cast<std::size_t>(before.data() - text.data()))),
                   false);
    return found(word, std::string(word), true);
  }
  return {};
}

/// What brackets say of a unit. In the midst of a heading they say less than at its end.
FoundUnit unit_in_brackets(const std::string& within, bool are_square, bool at_end,
                           std::string_view channel) {
  const FoundUnit none;
  const FoundUnit unknown{.unit = within, .is_known = false, .begin = 0};
  const FoundUnit known{.unit = within, .is_known = true, .begin = 0};
  if (trimmed(within).empty()) return none;
  if (is_number(within)) return at_end && is_known_unit(within) ? known : none;
  if (is_unit_alone(within)) return known;
  if (is_known_unit(within) || find_factor(within) != std::string::npos) return unknown;
  const bool says_unit =
      is_raw_unit(within) || looks_like_unit(within) || (are_square && !tells_columns_apart(within));
  return at_end && says_unit ? unknown : unit_among_words(within, channel);
}

/// Takes what stands in brackets off the name if it says the unit, of several the last; false if none does.
bool take_brackets(TextColumn& column) {
  for (const auto& brackets : {std::string_view("[]"), std::string_view("()")}) {
    const auto open = column.name.rfind(brackets[0]);
    const auto close = open == std::string::npos ? open : column.name.find(brackets[1], open);
    if (open == 0 || close == std::string::npos) continue;
    const std::string before(trimmed(std::string_view(column.name).substr(0, open)));
    const std::string behind(trimmed(std::string_view(column.name).substr(close + 1)));
    const FoundUnit found = unit_in_brackets(column.name.substr(open + 1, close - open - 1),
                                             brackets[0] == '[', behind.empty(), channel_said_by(before));
    if (found.begin == std::string::npos) continue;
    (found.is_known ? column.unit : column.unknown_unit) = found.unit;
    column.name = behind.empty() ? before : before + " " + behind;
    return true;
  }
  return false;
}

/// Takes " / mN" (DIN 1313) or " in mN" off the name; false if what follows is no known unit.
bool take_words(TextColumn& column) {
  for (const std::string_view between : {std::string_view(" / "), std::string_view(" in ")}) {
    const auto at = column.name.rfind(between);
    if (at == std::string::npos || at == 0) continue;
    const std::string unit(trimmed(std::string_view(column.name).substr(at + between.size())));
    if (!is_known_unit(unit) || is_number(unit) || unit == "in") continue;
    column.unit = unit;
    column.name = std::string(trimmed(std::string_view(column.name).substr(0, at)));
    return true;
  }
  return false;
}

/// Finds the unit among the words of the name, which keeps it.
void find_word(TextColumn& column) {
  const std::string_view channel = channel_said_by(column.name);
  FoundUnit found = unit_among_words(column.name, channel);
  if (found.begin == std::string::npos) {  // "F/mN"
    std::string parted = column.name;
    std::ranges::replace(parted, '/', ' ');
    found = unit_among_words(parted, channel);
  }
  if (found.begin != std::string::npos) (found.is_known ? column.unit : column.unknown_unit) = found.unit;
}

/// A factor beside the unit: whether the numbers were multiplied by it, or are to be, nobody can tell.
void doubt_factor(TextColumn& column, bool has_words) {
  const std::string text = has_words ? column.name : column.heading;
  const std::size_t at = find_factor(text);
  if (at == std::string::npos || is_number(column.unit)) return;
  const std::size_t open = text.find_first_of("([");
  column.unknown_unit = text.substr(std::min(at, open));
  column.unit.clear();
}

/// The unit that a heading is and nothing else; those of one letter may be a name.
std::optional<std::string> bare_unit(const TextColumn& column, const std::vector<TextColumn>& all) {
  const std::string& text = column.heading;
  constexpr std::array names{"in", "ft", "rev", "bar", "min", "lb", "oz"};
  if (!column.unit.empty() || !is_known_unit(text) || is_number(text)) return std::nullopt;
  const auto is_named = [&](std::string_view channel) {
    return std::ranges::any_of(all, [&](const TextColumn& c) { return words_of(c.name).says(channel); });
  };
  if (text == "N") return is_named("force") ? std::nullopt : std::optional(text);
  if (text == "s") return is_named("time") ? std::nullopt : std::optional(text);
  const bool may_be_a_name =
      text.size() < 2 || std::ranges::find(names, text) != names.end() || words_of(text).known != nullptr;
  return may_be_a_name ? std::nullopt : std::optional(text);
}

/// "M[1]", "M[2]": of columns of one name the numbers in brackets are none's units.
void take_numbers_for_names(std::vector<TextColumn>& columns) {
  const std::vector<TextColumn> named(columns);
  for (TextColumn& column : columns) {
    const auto of_its_name = std::ranges::count(named, column.name, &TextColumn::name);
    if (of_its_name > 1 && is_number(column.unit) && column.heading.ends_with(']'))
      column = {.heading = column.heading, .name = column.heading};
  }
}

}  // namespace

TextColumn named_column(std::string_view heading) {
  const std::string text = to_utf8(trimmed(heading));
  TextColumn column{.heading = text, .name = text};
  const bool has_words = take_words(column);
  if (!has_words && !take_brackets(column)) find_word(column);
  if (column.unknown_unit.empty()) doubt_factor(column, has_words);
  return column;
}

std::vector<TextColumn> named_columns(const std::vector<std::string_view>& fields) {
  std::vector<TextColumn> columns;
  for (const std::string_view field : fields) columns.push_back(named_column(field));
  take_numbers_for_names(columns);
  const std::vector<TextColumn> named(columns);
  for (TextColumn& column : columns) {
    if (const auto unit = bare_unit(column, named)) column.unit = *unit;
  }
  return columns;
}

}  // namespace kerf::bench
