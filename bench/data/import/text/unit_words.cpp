#include "import/text/unit_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include "files/trimmed.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

constexpr std::array raw_words{"counts", "count", "cts", "ticks", "adc",  "lsb",   "bits",
                               "raw",    "a.u.",  "a.u", "au",    "arb.", "steps", "pulses"};

/// Units that are none of ours.
constexpr std::array other_units{
    "dyn",     "dyne",    "dynes", "pond",  "tonf",   "ton",     "tons",     "kip",   "kips",
    "mil",     "mils",    "thou",  "yd",    "km",     "dm",      "gon",      "grad",  "grads",
    "arcmin",  "arcsec",  "turns", "cycle", "cycles", "segment", "segments", "point", "points",
    "samples", "rpm",     "ohm",   "ohms",  "torr",   "mmhg",    "atm",      "ksi",   "strain",
    "dmm",     "percent", "unit",  "units", "none",   "n/a",     "hex",      "dec"};

/// Two letters and less that stand behind a name and are no unit.
constexpr std::array short_words{"x", "y", "z", "id", "no", "nr", "l", "r"};

template <typename Words>
bool is_one_of(const Words& words, std::string_view text) {
  return std::ranges::find(words, text) != words.end();
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

bool is_known_unit(std::string_view text) {
  try {
    (void)parse_unit(text);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

bool is_raw_unit(std::string_view text) { return is_one_of(raw_words, in_small_letters(trimmed(text))); }

bool has_factor(std::string_view unknown_unit) {
  return unknown_unit.find_first_of("0123456789") != std::string_view::npos;
}

bool looks_like_unit(std::string_view text) {
  constexpr std::size_t longest = 12;
  text = trimmed(text);
  const std::string small = in_small_letters(text);
  if (text.empty() || text.size() > longest) return false;
  if (is_one_of(other_units, small) || is_known_unit(small)) return true;
  if (is_one_of(short_words, small)) return false;
  if (std::ranges::any_of(text, [](char c) { return c == ' ' || c == '=' || c == ','; })) return false;
  if (std::ranges::any_of(text, [](char c) { return c == '%' || c == '^' || c == '/'; })) return true;
  if (text.find("µ") == 0 || text.find("°") == 0 || text.find("\u03bc") == 0) return true;
  // "æm": a micrometre whose letter another encoding has spoiled.
  const auto ascii = std::ranges::find_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  if (ascii != text.begin() && is_known_unit(text.substr(static_cast<std::size_t>(ascii - text.begin()))))
    return true;
  if (!std::ranges::all_of(text, is_letter)) return false;
  if (text.size() <= 2) return true;
  // "mNM", "kPA": a capital behind a small letter.
  const bool has_inner_capital = std::isupper(static_cast<unsigned char>(text[1])) != 0;
  return text.size() <= 4 && std::islower(static_cast<unsigned char>(text[0])) != 0 && has_inner_capital;
}

}  // namespace kerf::bench
