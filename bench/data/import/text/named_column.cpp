#include "import/text/named_column.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>

#include "files/trimmed.h"
#include "import/text/column_words.h"
#include "import/text/unit_words.h"

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

/// Takes "[ms]" or "(N)" off the name; false if there is no unit in it.
bool take_brackets(TextColumn& column) {
  for (const auto& brackets : {std::string_view("[]"), std::string_view("()")}) {
    const auto open = column.name.rfind(brackets[0]);
    if (open == std::string::npos || open == 0 || column.name.back() != brackets[1]) continue;
    const std::string unit = column.name.substr(open + 1, column.name.size() - open - 2);
    const bool is_known = is_known_unit(unit);
    const bool says_unit =
        is_raw_unit(unit) || looks_like_unit(unit) || (brackets[0] == '[' && !tells_columns_apart(unit));
    if (!is_known && (!says_unit || trimmed(unit).empty())) continue;
    (is_known ? column.unit : column.unknown_unit) = unit;
    column.name = std::string(trimmed(std::string_view(column.name).substr(0, open)));
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

/// "pos_mm_min" -> "pos_mm": of which values of a bin a column is, which is no unit.
std::string_view without_statistic(std::string_view name) {
  constexpr std::array statistics{"min", "max", "mean", "avg", "median", "std", "stddev", "rms"};
  const auto at = name.rfind('_');
  if (at == std::string_view::npos || at == 0) return name;
  const std::string last = in_small_letters(name.substr(at + 1));
  const std::string_view before = name.substr(0, at);
  // "time_min" is in minutes, as far as anybody can tell.
  const bool is_time = last == "min" && words_of(before).says("time");
  return std::ranges::find(statistics, last) != statistics.end() && !is_time ? before : name;
}

/// The unit behind the last underscore: "t_s", and "F_mN_" of "F (mN)" that a program made a name of.
void find_suffix(TextColumn& column) {
  std::string_view name = column.name;
  while (name.ends_with('_')) name.remove_suffix(1);
  name = without_statistic(name);
  const auto underscore = name.rfind('_');
  if (underscore == std::string_view::npos || underscore == 0) return;
  const std::string unit(name.substr(underscore + 1));
  if (unit.empty() || std::isalpha(static_cast<unsigned char>(unit.front())) == 0) {
    if (!unit.starts_with("µ") && !unit.starts_with("\u03bc")) return;
  }
  constexpr std::array raw_suffixes{"raw", "counts", "adc", "lsb", "ticks"};
  if (std::ranges::find(raw_suffixes, in_small_letters(unit)) != raw_suffixes.end())
    column.unknown_unit = unit;
  // Of a voltage in, a hand's h, a revision.
  const ColumnWords words = words_of(name.substr(0, underscore));
  const bool is_word =
      unit == "rev" || (unit == "in" && !words.says("position")) || (unit == "h" && !words.says("time"));
  if (is_word || !is_known_unit(unit)) return;
  // Programmers write N·m so, too.
  (unit == "nm" ? column.unknown_unit : column.unit) = unit;
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
  if (!take_brackets(column) && !take_words(column)) find_suffix(column);
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
