#include "units/units.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "files/trimmed.h"
#include "units/unit_symbols.h"

namespace kerf::bench {
namespace {

const Symbol& find_symbol(std::string_view text, std::string_view whole) {
  if (const Symbol* const found = symbol_called(text)) return *found;
  std::string known;
  for (const Symbol& symbol : unit_symbols())
    known += fmt::format("{}{}", known.empty() ? "" : " ", symbol.text);
  throw std::invalid_argument(fmt::format("unknown unit '{}' in '{}'; known are {}", text, whole, known));
}

/// How many of what the file has are one unit, which is to be told: "? N", as a proposed map has it.
void require_no_question(std::string_view text) {
  if (!text.starts_with('?')) return;
  const std::string_view unit = trimmed(text.substr(1));
  throw std::invalid_argument(fmt::format(
      "write for ? in '{}' how many {} one of the file's units is, as in 0.001 {}", text, unit, unit));
}

/// Takes a leading number ("0.0439 deg", "1/mm") off the text.
double take_factor(std::string_view& text) {
  double factor = 1.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
  if (error != std::errc{}) return 1.0;
  text = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  return factor;
}

/// Takes "counts/1000000" off a text that goes on with the unit: of raw numbers of which so many are one
/// unit.
double take_counts_per(std::string_view& text) {
  constexpr std::string_view word = "counts/";
  if (!text.starts_with(word)) return 1.0;
  std::string_view rest = text.substr(word.size());
  if (rest.starts_with('?')) {
    const std::string_view unit = trimmed(rest.substr(1));
    throw std::invalid_argument(fmt::format(
        "write for ? in '{}' how many counts are one {}, as in counts/1000 {}", text, unit, unit));
  }
  double counts = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), counts);
  const std::string_view unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (error != std::errc{} || unit.empty() || unit.data() == end)
    throw std::invalid_argument(fmt::format(
        "unit '{}' does not say how many counts are what; expected for example counts/1000000 N", text));
  text = unit;
  return 1.0 / counts;
}

constexpr std::array<const char*, 4> power_texts{"", "", "²", "³"};

/// Takes "²", "³", "^2" or "^3" off the end of a symbol.
int take_power(std::string_view& text) {
  for (const auto& [ending, power] :
       std::initializer_list<std::pair<std::string_view, int>>{{"²", 2}, {"³", 3}, {"^2", 2}, {"^3", 3}}) {
    if (!text.ends_with(ending)) continue;
    text.remove_suffix(ending.size());
    return power;
  }
  return 1;
}

using Parts = std::vector<std::string>;

/// Adds the factors of an SI unit, raised to a power: "N·m" has two above, "rad/s" one above and one below.
void add_parts(std::string_view si, int power, Parts& above, Parts& below) {
  Parts* side = &above;
  while (!si.empty()) {
    const auto end = std::min({si.find("·"), si.find('/'), si.size()});
    const std::string_view part = si.substr(0, end);
    if (part != "1") side->push_back(std::string(part) + power_texts.at(static_cast<std::size_t>(power)));
    if (end == si.size()) return;
    const bool divides = si[end] == '/';
    if (divides) side = &below;
    si.remove_prefix(end + (divides ? 1 : std::string_view("·").size()));
  }
}

/// Joins factors of a product in the order written, as a text.
std::string joined(const Parts& parts) { return fmt::format("{}", fmt::join(parts, "·")); }

}  // namespace

Unit parse_unit(std::string_view given) {
  std::string_view text = trimmed(given);
  if (text.empty()) throw std::invalid_argument("an empty unit; write 1 for a plain number");
  require_no_question(text);
  const double of_a_count = take_counts_per(text);
  Unit unit{.factor = of_a_count * take_factor(text), .si = {}, .offset = 0.0};
  const bool is_fahrenheit = text == "degF" || text == "°F";
  Parts above;
  Parts below;
  bool divides = false;
  while (!text.empty()) {
    const auto end = std::min({text.find("·"), text.find('*'), text.find('/'), text.size()});
    const bool begins_with_divisor = !divides && above.empty() && text.starts_with('/');
    std::string_view name = begins_with_divisor ? "1" : trimmed(text.substr(0, end));
    const int power = take_power(name);
    const Symbol& symbol = find_symbol(name, given);
    const double factor = std::pow(symbol.factor, power);
    unit.factor = divides ? unit.factor / factor : unit.factor * factor;
    add_parts(symbol.si, power, divides ? below : above, divides ? above : below);
    if (end == text.size()) break;
    divides = divides || text[end] == '/';
    text.remove_prefix(end + (text.substr(end).starts_with("·") ? std::string_view("·").size() : 1));
    if (trimmed(text).empty())
      throw std::invalid_argument(fmt::format("unit '{}' ends in an operator", given));
  }
  // Of a prefix too: 1e308/mm is more than a double holds.
  if (!std::isfinite(unit.factor) || unit.factor == 0.0) {
    throw std::invalid_argument(
        fmt::format("the factor in unit '{}' must be a finite number other than zero", given));
  }
  if (is_fahrenheit) unit.offset = -32.0 / 1.8;
  unit.si = joined(above);
  if (unit.si.empty()) unit.si.push_back('1');
  if (const std::string divisor = joined(below); !divisor.empty()) unit.si += "/" + divisor;
  return unit;
}

std::string_view without_factor(std::string_view text) {
  text = trimmed(text);
  (void)take_counts_per(text);
  (void)take_factor(text);
  return text;
}

std::vector<std::string> symbols_of(std::string_view si) {
  std::vector<std::string> texts;
  std::vector<double> factors;
  for (const Symbol& symbol : unit_symbols()) {
    if (symbol.si != si || std::ranges::find(factors, symbol.factor) != factors.end()) continue;
    factors.push_back(symbol.factor);
    texts.emplace_back(symbol.text);
  }
  if (si.ends_with("/s")) {
    for (const std::string& above : symbols_of(si.substr(0, si.size() - 2))) texts.push_back(above + "/s");
  }
  return texts;
}

std::vector<std::string> all_symbols() {
  std::vector<std::string> texts;
  for (const Symbol& symbol : unit_symbols()) {
    const bool is_another_spelling = symbol.text.starts_with("µ") || symbol.text.starts_with("°");
    if (!is_another_spelling) texts.emplace_back(symbol.text);
  }
  return texts;
}

std::string work_unit(std::string_view force_unit, std::string_view position_unit) {
  const bool is_energy =
      (force_unit == "N" && position_unit == "m") || (force_unit == "N·m" && position_unit == "rad");
  return is_energy ? "J" : fmt::format("{}·{}", force_unit, position_unit);
}

}  // namespace kerf::bench
