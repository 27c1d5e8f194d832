#include "kerf/compare/diagnose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <fmt/core.h>

#include "diagnosis/pair.h"

namespace kerf::compare {
namespace {

constexpr std::array<std::string_view, 24> change_names{
    "rounding", "not_finite", "silence", "stuck",      "sign",  "axes",  "rotation",   "unit",
    "gain",     "offset",     "drift",   "saturation", "lag",   "rate",  "lost",       "doubled",
    "inserted", "repeated",   "spike",   "vibration",  "noise", "state", "trajectory", "parameters"};
static_assert(change_names.size() == static_cast<std::size_t>(Change::parameters) + 1);

void require_same_channels(const Series& expected, const Series& got) {
  const auto same = [](const Channel& a, const Channel& b) { return a.name == b.name && a.unit == b.unit; };
  if (std::ranges::equal(expected.channels, got.channels, same)) return;
  throw std::invalid_argument(fmt::format("the forces are {} where {} are expected", names_of(got.channels),
                                          names_of(expected.channels)));
}

/// Columns without what is not finite in either run: there both are zero.
struct Finite {
  Series expected;
  Series got;
  Findings found;
};

Finite finite_of(const Series& expected, const Series& got) {
  Finite finite{.expected = expected, .got = got};
  for (std::size_t channel = 0; channel < got.channels.size(); ++channel) {
    auto& e = finite.expected.channels[channel].value;
    auto& g = finite.got.channels[channel].value;
    std::size_t count = 0;
    std::size_t first = 0;
    for (std::size_t row = 0; row < std::max(e.size(), g.size()); ++row) {
      const bool bad_e = row < e.size() && !std::isfinite(e[row]);
      const bool bad_g = row < g.size() && !std::isfinite(g[row]);
      if (!bad_e && !bad_g) continue;
      if (count++ == 0) first = row;
      if (row < e.size()) e[row] = 0.0;
      if (row < g.size()) g[row] = 0.0;
    }
    if (count == 0) continue;
    finite.found.push_back(
        {.change = Change::not_finite,
         .channels = {channel},
         .remainder = 0.0,
         .sentence = fmt::format("not finite from row {}, {} row{}", first, count, count > 1 ? "s" : ""),
         .numbers = {{"row", static_cast<double>(first)}, {"count", static_cast<double>(count)}}});
  }
  return finite;
}

ForcePair pair_of(const Series& expected, const Series& got, std::size_t channel) {
  const Channel& e = expected.channels[channel];
  const Channel& g = got.channels[channel];
  const std::size_t rows = std::min(e.value.size(), g.value.size());
  ForcePair pair{.channel = channel,
                 .unit = e.unit,
                 .expected = std::span(e.value).first(rows),
                 .got = std::span(g.value).first(rows),
                 .period_s = expected.period()};
  double square = 0.0;
  double most = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    pair.peak = std::max({pair.peak, std::abs(pair.expected[row]), std::abs(pair.got[row])});
    pair.difference.push_back(pair.got[row] - pair.expected[row]);
    most = std::max(most, std::abs(pair.difference.back()));
    square += pair.difference.back() * pair.difference.back();
  }
  pair.tiny = 1e-9 * pair.peak;
  pair.differs = most > pair.tiny;
  pair.rms_difference = rows > 0 ? std::sqrt(square / static_cast<double>(rows)) : 0.0;
  for (std::size_t row = 0; row < rows; ++row)
    pair.contact.push_back(std::max(std::abs(pair.expected[row]), std::abs(pair.got[row])) > pair.tiny ? 1
                                                                                                       : 0);
  return pair;
}

bool bits_differ(const ForcePair& pair) {
  return std::ranges::any_of(pair.difference, [](double one) { return one != 0.0; });
}

/// Two channels in which the same happened.
bool is_same(const Finding& a, const Finding& b) {
  return a.change == b.change && a.numbers.size() == b.numbers.size() &&
         std::ranges::equal(a.numbers, b.numbers, [](const auto& x, const auto& y) {
           return x.first == y.first &&
                  (x.first.starts_with("std_error") || x.first == "size" ||
                   std::abs(x.second - y.second) <= 1e-2 * std::max(std::abs(x.second), std::abs(y.second)));
         });
}

void merge(Findings& found) {
  Findings merged;
  for (Finding& one : found) {
    const auto same = std::ranges::find_if(merged, [&](const Finding& other) { return is_same(one, other); });
    if (same == merged.end()) {
      merged.push_back(std::move(one));
      continue;
    }
    for (const std::size_t channel : one.channels) {
      if (!std::ranges::count(same->channels, channel)) same->channels.push_back(channel);
    }
    same->remainder = std::max(same->remainder, one.remainder);
  }
  found = std::move(merged);
}

bool is_about(const Finding& finding, std::size_t channel) {
  return std::ranges::count(finding.channels, channel) > 0;
}

/// Those that explain their channels, and for every other channel the two that come nearest.
Diagnosis judged(Findings found, const std::vector<ForcePair>& pairs) {
  // By what they leave, and those that leave as much as nothing by how much they say.
  std::ranges::stable_sort(found, {}, [](const Finding& one) {
    return std::pair{std::round(200.0 * one.remainder), static_cast<int>(one.change)};
  });
  Diagnosis result;
  Findings guesses;
  for (Finding& one : found)
    (one.remainder <= named_remainder ? result.names : guesses).push_back(std::move(one));
  for (const ForcePair& pair : pairs) {
    const auto about = [&](const Finding& one) { return is_about(one, pair.channel); };
    if (!pair.differs || std::ranges::any_of(result.names, about)) continue;
    result.explained = false;
    std::vector<Change> taken;
    for (const Finding& one : guesses) {
      if (!about(one) || taken.size() == 2 || std::ranges::count(taken, one.change)) continue;
      taken.push_back(one.change);
      result.guesses.push_back(one);
      result.guesses.back().channels = {pair.channel};
    }
  }
  merge(result.names);
  merge(result.guesses);
  return result;
}

std::string with_names(std::string sentence, const Series& series) {
  for (std::size_t i = 0; i < series.channels.size(); ++i) {
    const std::string place = fmt::format("{{{}}}", i);
    for (std::size_t at = sentence.find(place); at != std::string::npos; at = sentence.find(place))
      sentence.replace(at, place.size(), series.channels[i].name);
  }
  return sentence;
}

std::string channels_in_words(const std::vector<std::size_t>& channels, const Series& series) {
  if (series.channels.size() == 1) return "";
  std::string text;
  for (const std::size_t channel : channels)
    text += (text.empty() ? "" : ", ") + series.channels[channel].name;
  return text + ": ";
}

/// Whether all runs differ by no more than the last digits.
bool only_rounding(const std::vector<ForcePair>& pairs, const Series& expected, const Series& got) {
  return expected.rows() == got.rows() && std::ranges::any_of(pairs, bits_differ) &&
         std::ranges::none_of(pairs, &ForcePair::differs);
}

void find_in_each(const std::vector<ForcePair>& pairs, const Series& expected, const Series& got,
                  const Facts& facts, Findings& found) {
  for (const ForcePair& pair : pairs) {
    if (!pair.differs) continue;
    find_scales(pair, found);
    find_stretches(pair, found);
    find_times(pair, found);
    find_waves(pair, found);
    find_state(pair, found);
    find_motion(pair, expected, got, facts, found);
  }
  find_axes(pairs, found);
}

/// Rows that the times say are missing, and what else is other among those that both have.
Diagnosis diagnosed_beside_gaps(const Series& expected, const Series& got, const Facts& facts,
                                Findings missing, const MatchedRows& rows) {
  Diagnosis result = diagnose(rows_of(expected, rows.expected), rows_of(got, rows.got), facts);
  for (Findings* const findings : {&result.names, &result.guesses}) {
    for (Finding& one : *findings) one.sentence = "besides, counted in rows that both have: " + one.sentence;
  }
  result.names.insert(result.names.begin(), std::make_move_iterator(missing.begin()),
                      std::make_move_iterator(missing.end()));
  return result;
}

}  // namespace

std::string_view name_of(Change change) noexcept { return change_names[static_cast<std::size_t>(change)]; }

void add_finding(Findings& found, const ForcePair& pair, Finding finding) {
  if (!(finding.remainder < guessed_remainder)) return;
  finding.channels = {pair.channel};
  found.push_back(std::move(finding));
}

Diagnosis diagnose(const Series& expected, const Series& got, const Facts& facts) {
  require_same_channels(expected, got);
  Finite finite = finite_of(expected, got);
  std::vector<ForcePair> pairs;
  for (std::size_t channel = 0; channel < expected.channels.size(); ++channel)
    pairs.push_back(pair_of(finite.expected, finite.got, channel));
  Findings found = std::move(finite.found);
  if (only_rounding(pairs, expected, got) && found.empty()) {
    found.push_back({.change = Change::rounding, .remainder = 0.0, .sentence = "the last digits alone"});
    for (const ForcePair& pair : pairs) {
      if (bits_differ(pair)) found.back().channels.push_back(pair.channel);
    }
    return {.names = std::move(found)};
  }
  Findings edits;
  find_edits(finite.expected, finite.got, pairs, edits);
  const auto explains = [](const Finding& one) { return one.remainder <= named_remainder; };
  if (!edits.empty() && std::ranges::none_of(edits, explains)) {
    const auto rows = matched_rows(finite.expected, finite.got);
    if (rows && rows->by_time) return diagnosed_beside_gaps(expected, got, facts, std::move(edits), *rows);
  }
  found.insert(found.end(), edits.begin(), edits.end());
  if (expected.rows() == got.rows()) {
    find_in_each(pairs, finite.expected, finite.got, facts, found);
    return judged(std::move(found), pairs);
  }
  // A run of another length is explained by what makes it so, or not at all.
  for (ForcePair& pair : pairs)
    find_rate(pair, finite.expected.channels[pair.channel].value, finite.got.channels[pair.channel].value,
              found);
  Diagnosis result = judged(found, pairs);
  if (!result.names.empty()) return result;
  find_in_each(pairs, finite.expected, finite.got, facts, found);
  for (Finding& one : found) one.remainder = std::max(one.remainder, 1.01 * named_remainder);
  result = judged(std::move(found), pairs);
  result.explained = false;
  return result;
}

std::vector<std::string> sentences_of(const Diagnosis& diagnosis, const Series& expected) {
  std::vector<std::string> lines;
  std::vector<std::vector<std::size_t>> said;
  for (const Finding& one : diagnosis.names) {
    const bool again = std::ranges::count(said, one.channels) > 0;
    lines.push_back(channels_in_words(one.channels, expected) + (again ? "or " : "") +
                    with_names(one.sentence, expected));
    if (one.remainder <= named_remainder) said.push_back(one.channels);
  }
  if (diagnosis.explained) return lines;
  std::string text = "unexplained";
  for (const Finding& one : diagnosis.guesses)
    text += fmt::format("{} {}{}, which leaves {:.0f} % of the difference",
                        text == "unexplained" ? "; the nearest are:" : ";",
                        channels_in_words(one.channels, expected), with_names(one.sentence, expected),
                        100.0 * one.remainder);
  lines.push_back(std::move(text));
  return lines;
}

}  // namespace kerf::compare
