#include "import/text/column_words.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "import/text/unit_words.h"

namespace kerf::bench {
namespace {

constexpr std::array known_names{
    KnownName{"time", "time", "s"},
    KnownName{"timestamp", "time", "s"},
    KnownName{"t", "time", "s"},
    KnownName{"stamp", "time", "s"},
    KnownName{"zeit", "time", "s"},
    KnownName{"temps", "time", "s"},
    KnownName{"tiempo", "time", "s"},
    KnownName{"elapsed", "time", "s"},
    KnownName{"seconds", "time", "s"},
    KnownName{"position", "position", "mm"},
    KnownName{"pos", "position", "mm"},
    KnownName{"x", "position", "mm"},
    KnownName{"displacement", "position", "mm"},
    KnownName{"disp", "position", "mm"},
    KnownName{"travel", "position", "mm"},
    KnownName{"stroke", "position", "mm"},
    KnownName{"crosshead", "position", "mm"},
    KnownName{"depth", "position", "mm"},
    KnownName{"indentation", "position", "mm"},
    KnownName{"extension", "position", "mm"},
    KnownName{"distance", "position", "mm"},
    KnownName{"weg", "position", "mm"},
    KnownName{"desplazamiento", "position", "mm"},
    KnownName{"pose", "position", "m"},
    KnownName{"angle", "position", "deg"},
    KnownName{"rotation", "position", "deg"},
    KnownName{"theta", "position", "deg"},
    KnownName{"force", "force", "N"},
    KnownName{"load", "force", "N"},
    KnownName{"f", "force", "N"},
    KnownName{"fz", "force", "N"},
    KnownName{"kraft", "force", "N"},
    KnownName{"fuerza", "force", "N"},
    KnownName{"weight", "force", "? N"},
    KnownName{"torque", "force", "Nm"},
};

constexpr std::array counters{"sample",   "samples", "index",    "idx",    "point",   "points",
                              "sequence", "seq",     "count",    "counts", "counter", "row",
                              "rows",     "line",    "lines",    "number", "scan",    "record",
                              "frame",    "segment", "segments", "cycle",  "cycles"};
/// These where they are all there is.
constexpr std::array short_counters{"n", "no", "nr", "id", "i", "num"};

constexpr std::array other_things{
    "setpoint",  "target",   "commanded", "command",  "cmd",       "desired",      "demand", "demanded",
    "goal",      "set",      "soll",      "sollwert", "sollkraft", "reference",    "ref",    "predicted",
    "planned",   "nominal",  "residual",  "error",    "err",       "std",          "stddev", "sd",
    "variance",  "noise",    "velocity",  "speed",    "rate",      "acceleration", "temp",   "temperature",
    "stiffness", "duration", "interval",  "period",   "delay",     "delta",        "dt",     "limit",
    "max",       "min",      "gain",      "offset"};

template <typename Words>
bool has_word(const Words& words, std::string_view text) {
  return std::ranges::find(words, text) != words.end();
}

const KnownName* name_of(std::string_view word) {
  const auto* const found = std::ranges::find(known_names, word, &KnownName::word);
  return found == known_names.end() ? nullptr : found;
}

bool is_of_word(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_capital(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::vector<std::string> split_into_words(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(in_small_letters(word));
    word.clear();
  };
  for (const char c : name) {
    const bool is_hump = !word.empty() && is_capital(c) && !is_capital(word.back());
    if (!is_of_word(c) || is_hump) end_word();
    if (is_of_word(c)) word += c;
  }
  end_word();
  return words;
}

ColumnWords words_of(std::string_view name) {
  const std::vector<std::string> words = split_into_words(name);
  ColumnWords found;
  if (words.empty()) {
    found.counts = name == "#";
    return found;
  }
  found.counts = std::ranges::any_of(words, [](const auto& word) { return has_word(counters, word); }) ||
                 (words.size() == 1 && has_word(short_counters, words.front()));
  found.is_other = std::ranges::any_of(words, [](const auto& word) { return has_word(other_things, word); });
  found.known = name_of(words.front());
  if (found.known != nullptr) found.naming = Naming::first_word;
  for (std::size_t i = 1; i < words.size(); ++i) {
    // A letter among words is an axis, or what a formula has: "Sensor t" is no time.
    const bool says_more = found.known == nullptr || found.known->word.size() == 1;
    if (words[i].size() == 1 || !says_more) continue;
    if (const KnownName* const known = name_of(words[i])) {
      found.known = known;
      found.naming = Naming::another_word;
    }
  }
  // "Scan Time" is a time; "F/T Sequence" is no force.
  if (found.known != nullptr && found.known->word.size() > 1) found.counts = false;
  if (found.counts) found.known = nullptr;
  return found;
}

}  // namespace kerf::bench
