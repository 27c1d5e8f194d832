#include "units/unit_symbols.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <string>

namespace kerf::bench {
namespace {

constexpr double standard_gravity = 9.80665;  // [m/s^2], by definition; makes gram-force a force
constexpr double inch = 0.0254;               // exact, since 1959
constexpr double pound = 0.45359237;          // likewise [kg]

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
    Symbol{"nm", 1e-9, "m"},
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
    Symbol{"uN", 1e-6, "N"},
    Symbol{"µN", 1e-6, "N"},
    Symbol{"nN", 1e-9, "N"},
    Symbol{"pN", 1e-12, "N"},
    Symbol{"cN", 1e-2, "N"},
    Symbol{"daN", 10.0, "N"},
    Symbol{"gf", 1e-3 * standard_gravity, "N"},
    Symbol{"kgf", standard_gravity, "N"},
    Symbol{"lbf", pound* standard_gravity, "N"},
    Symbol{"ozf", pound / 16.0 * standard_gravity, "N"},
    Symbol{"Nm", 1.0, "N·m"},
    Symbol{"mNm", 1e-3, "N·m"},
    Symbol{"Nmm", 1e-3, "N·m"},
    Symbol{"Ncm", 1e-2, "N·m"},
    Symbol{"J", 1.0, "J"},
    Symbol{"mJ", 1e-3, "J"},
    Symbol{"kJ", 1e3, "J"},
    Symbol{"V", 1.0, "V"},
    Symbol{"mV", 1e-3, "V"},
    Symbol{"uV", 1e-6, "V"},
    Symbol{"µV", 1e-6, "V"},
    Symbol{"A", 1.0, "A"},
    Symbol{"mA", 1e-3, "A"},
    Symbol{"Hz", 1.0, "Hz"},
    Symbol{"kHz", 1e3, "Hz"},
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
    Symbol{"mg", 1e-6, "kg"},
    Symbol{"lb", pound, "kg"},
    Symbol{"oz", pound / 16.0, "kg"},
    Symbol{"%", 1e-2, "1"},
};

/// Another spelling of a symbol.
struct Alias {
  std::string_view text;
  std::string_view symbol;
};

/// As they stand: where another case would say another unit, as "MN" does of "mN", there is none.
constexpr std::array aliases{
    Alias{"KN", "kN"},    Alias{"MM", "mm"},  Alias{"CM", "cm"},  Alias{"IN", "in"},    Alias{"KPa", "kPa"},
    Alias{"Mpa", "MPa"},  Alias{"KG", "kg"},  Alias{"Kg", "kg"},  Alias{"gr", "g"},     Alias{"kp", "kgf"},
    Alias{"N-m", "Nm"},   Alias{"N.m", "Nm"}, Alias{"N m", "Nm"}, Alias{"N-mm", "Nmm"}, Alias{"N.mm", "Nmm"},
    Alias{"N mm", "Nmm"}, Alias{"º", "°"},    Alias{"℃", "°C"},   Alias{"秒", "s"},     Alias{"hr", "h"},
    Alias{"hrs", "h"},
};

/// Words that say one unit in whatever case.
constexpr std::array words{
    Alias{"sec", "s"},           Alias{"secs", "s"},         Alias{"second", "s"},
    Alias{"seconds", "s"},       Alias{"sekunden", "s"},     Alias{"msec", "ms"},
    Alias{"msecs", "ms"},        Alias{"millisecond", "ms"}, Alias{"milliseconds", "ms"},
    Alias{"usec", "us"},         Alias{"usecs", "us"},       Alias{"microsecond", "us"},
    Alias{"microseconds", "us"}, Alias{"nsec", "ns"},        Alias{"nanosecond", "ns"},
    Alias{"nanoseconds", "ns"},  Alias{"mins", "min"},       Alias{"minute", "min"},
    Alias{"minutes", "min"},     Alias{"hour", "h"},         Alias{"hours", "h"},
    Alias{"meter", "m"},         Alias{"meters", "m"},       Alias{"metre", "m"},
    Alias{"metres", "m"},        Alias{"centimeter", "cm"},  Alias{"centimeters", "cm"},
    Alias{"centimetre", "cm"},   Alias{"centimetres", "cm"}, Alias{"millimeter", "mm"},
    Alias{"millimeters", "mm"},  Alias{"millimetre", "mm"},  Alias{"millimetres", "mm"},
    Alias{"micron", "um"},       Alias{"microns", "um"},     Alias{"micrometer", "um"},
    Alias{"micrometers", "um"},  Alias{"micrometre", "um"},  Alias{"micrometres", "um"},
    Alias{"nanometer", "nm"},    Alias{"nanometers", "nm"},  Alias{"nanometre", "nm"},
    Alias{"nanometres", "nm"},   Alias{"inch", "in"},        Alias{"inches", "in"},
    Alias{"feet", "ft"},         Alias{"degree", "deg"},     Alias{"degrees", "deg"},
    Alias{"degs", "deg"},        Alias{"radian", "rad"},     Alias{"radians", "rad"},
    Alias{"newton", "N"},        Alias{"newtons", "N"},      Alias{"millinewton", "mN"},
    Alias{"millinewtons", "mN"}, Alias{"kilonewton", "kN"},  Alias{"kilonewtons", "kN"},
    Alias{"lbf", "lbf"},         Alias{"kgf", "kgf"},        Alias{"volt", "V"},
    Alias{"volts", "V"},         Alias{"gram", "g"},         Alias{"grams", "g"},
    Alias{"gms", "g"},           Alias{"kgs", "kg"},         Alias{"kilogram", "kg"},
    Alias{"kilograms", "kg"},    Alias{"lbs", "lb"},         Alias{"pound", "lb"},
    Alias{"pounds", "lb"},       Alias{"ounce", "oz"},       Alias{"ounces", "oz"},
};

const Symbol* symbol_of(std::string_view text) {
  const auto* const found = std::ranges::find(symbols, text, &Symbol::text);
  return found == symbols.end() ? nullptr : found;
}

/// The Greek letter mu, as keyboards have it, as the sign for micro.
std::string with_micro_sign(std::string_view text) {
  constexpr std::string_view mu = "\u03bc";
  return text.starts_with(mu) ? "µ" + std::string(text.substr(mu.size())) : std::string(text);
}

}  // namespace

std::span<const Symbol> unit_symbols() noexcept { return symbols; }

const Symbol* symbol_called(std::string_view text) {
  const std::string name = with_micro_sign(text);
  if (const Symbol* const found = symbol_of(name)) return found;
  if (const auto* const alias = std::ranges::find(aliases, name, &Alias::text); alias != aliases.end())
    return symbol_of(alias->symbol);
  std::string small = name;
  std::ranges::transform(small, small.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* const word = std::ranges::find(words, small, &Alias::text);
  return word == words.end() ? nullptr : symbol_of(word->symbol);
}

}  // namespace kerf::bench
