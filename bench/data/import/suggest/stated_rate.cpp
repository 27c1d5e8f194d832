#include "import/suggest/stated_rate.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "import/decimal.h"
#include "import/text/text_layout.h"
#include "import/text/unit_words.h"

namespace kerf::bench {
namespace {

constexpr std::array rate_words{
    "sample rate",      "sampling rate",  "samplerate", "sample frequency", "sampling frequency",
    "acquisition rate", "recording rate", "data rate",  "scan rate",        "fs"};

/// The factor to Hz that a line names; nothing if it names none, or a rate of something else.
std::optional<double> factor_to_hz(const std::string& line) {
  const auto at = line.find("hz");
  if (at == std::string::npos || line.find("hz", at + 1) != std::string::npos) return std::nullopt;
  const char before = at > 0 ? line[at - 1] : ' ';
  if (before == 'k') return 1e3;
  return std::isalpha(static_cast<unsigned char>(before)) != 0 ? std::nullopt : std::optional(1.0);
}

/// The only number of a text.
std::optional<double> only_number(std::string_view text) {
  std::optional<double> found;
  for (std::size_t at = 0; at < text.size();) {
    double value = 0.0;
    const char* const begin = text.data() + at;
    const bool may_begin = std::isdigit(static_cast<unsigned char>(text[at])) != 0;
    const char* const end = may_begin ? parse_decimal(begin, text.data() + text.size(), '.', value) : begin;
    if (end == begin) {
      ++at;
      continue;
    }
    if (found) return std::nullopt;
    found = value;
    at += static_cast<std::size_t>(end - begin);
  }
  return found;
}

std::optional<double> rate_of(std::string_view text) {
  std::string line = in_small_letters(text);
  while (!line.empty() && std::isalnum(static_cast<unsigned char>(line.front())) == 0) line.erase(0, 1);
  const auto begins = [&](std::string_view word) {
    return line.starts_with(word) &&
           (line.size() == word.size() || std::isalnum(static_cast<unsigned char>(line[word.size()])) == 0);
  };
  if (std::ranges::none_of(rate_words, begins)) return std::nullopt;
  const auto factor = factor_to_hz(line);
  const auto number = only_number(line);
  if (!factor || !number || !(*number > 0.0)) return std::nullopt;
  return *factor * *number;
}

}  // namespace

std::optional<double> stated_rate(std::string_view preamble) {
  std::optional<double> found;
  while (!preamble.empty()) {
    const auto rate = rate_of(take_line(preamble));
    if (!rate) continue;
    if (found && *found != *rate) return std::nullopt;
    found = rate;
  }
  return found;
}

}  // namespace kerf::bench
