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

namespace kerf::bench {
namespace {

constexpr double standard_gravity = 9.80665;  // [m/s^2], by definition; makes gram-force a force
constexpr double inch = 0.0254;               // exact, since 1959
constexpr double pound = 0.45359237;          // likewise [kg]

struct Symbol {
  std::string_view text;
  double factor;
  std::string_view si;
};

constexpr std::array symbols{
    Symbol{"1", 1.0, "1"},
    Symbol{"s", 1.0, "s"},
    Symbol{"ms", 1e-3, "s"},
    Symbol{"us", 1e-6, "s"},
    Symbol{"µs", 1e-6, "s"},
    Symbol{"ns", 1e-9, "s"},
    Symbol{"min", 60.0, "s"},
    Symbol{"h", 3600.0, "s"},
    Symbol{"m", 1.0, "m"},
    Symbol{"cm", 1e-2, "m"},
    Symbol{"mm", 1e-3, "m"},
    Symbol{"um", 1e-6, "m"},
    Symbol{"µm", 1e-6, "m"},
    Symbol{"in", inch, "m"},
    Symbol{"ft", 12.0 * inch, "m"},
    Symbol{"rad", 1.0, "rad"},
    Symbol{"mrad", 1e-3, "rad"},
    Symbol{"deg", std::numbers::pi / 180.0, "rad"},
    Symbol{"°", std::numbers::pi / 180.0, "rad"},
    Symbol{"rev", 2.0 * std::numbers::pi, "rad"},
    Symbol{"rpm", std::numbers::pi / 30.0, "rad/s"},
    Symbol{"N", 1.0, "N"},
    Symbol{"mN", 1e-3, "N"},
    Symbol{"kN", 1e3, "N"},
    Symbol{"gf", 1e-3 * standard_gravity, "N"},
    Symbol{"kgf", standard_gravity, "N"},
    Symbol{"lbf", pound* standard_gravity, "N"},
    Symbol{"ozf", pound / 16.0 * standard_gravity, "N"},
    Symbol{"Nm", 1.0, "N·m"},
    Symbol{"mNm", 1e-3, "N·m"},
    Symbol{"J", 1.0, "J"},
    Symbol{"mJ", 1e-3, "J"},
    Symbol{"kJ", 1e3, "J"},
    Symbol{"V", 1.0, "V"},
    Symbol{"mV", 1e-3, "V"},
    Symbol{"A", 1.0, "A"},
    Symbol{"mA", 1e-3, "A"},
    Symbol{"Hz", 1.0, "Hz"},
    Symbol{"Pa", 1.0, "Pa"},
    Symbol{"kPa", 1e3, "Pa"},
    Symbol{"MPa", 1e6, "Pa"},
    Symbol{"bar", 1e5, "Pa"},
    Symbol{"psi", pound* standard_gravity / (inch * inch), "Pa"},
    Symbol{"degC", 1.0, "°C"},
    Symbol{"°C", 1.0, "°C"},
    Symbol{"degF", 1.0 / 1.8, "°C"},
    Symbol{"°F", 1.0 / 1.8, "°C"},
    Symbol{"kg", 1.0, "kg"},
    Symbol{"g", 1e-3, "kg"},
    Symbol{"%", 1e-2, "1"},
};

const Symbol& find_symbol(std::string_view text, std::string_view whole) {
  const auto* const place =
      std::find_if(symbols.begin(), symbols.end(), [&](const Symbol& symbol) { return symbol.text == text; });
  if (place != symbols.end()) return *place;
  std::string known;
  for (const Symbol& symbol : symbols) known += fmt::format("{}{}", known.empty() ? "" : " ", symbol.text);
  throw std::invalid_argument(fmt::format("unknown unit '{}' in '{}'; known are {}", text, whole, known));
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

std::vector<std::string> symbols_of(std::string_view si) {
  std::vector<std::string> texts;
  std::vector<double> factors;
  for (const Symbol& symbol : symbols) {
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
  for (const Symbol& symbol : symbols) {
    const bool is_another_spelling =
        symbol.text == "µs" || symbol.text == "µm" || symbol.text.starts_with("°");
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
