#include "clocks/marker_fit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include "clocks/marker_match.h"
#include "files/trimmed.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
/// How far a marker may lie off the line, in steps of both clocks.
constexpr double most_steps_off = 2.0;

/// Student's t for an interval of 95 %.
double t95_of(std::size_t degrees) {
  constexpr std::array table{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                             2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131};
  return degrees <= table.size() ? table.at(degrees - 1) : 1.96 + 2.5 / static_cast<double>(degrees);
}

MarkerRule rule_of(std::string_view text) {
  MarkerRule rule;
  const auto at = text.find_first_of("<>");
  rule.falls = at != std::string_view::npos && text[at] == '<';
  rule.channel = trimmed(text.substr(0, at));
  if (at != std::string_view::npos) {
    const std::string_view level = trimmed(text.substr(at + 1));
    const char* const end = level.data() + level.size();
    const auto [rest, error] = std::from_chars(level.data(), end, rule.level);
    rule.has_level = error == std::errc() && rest == end && std::isfinite(rule.level);
  }
  if (rule.channel.empty() || (at != std::string_view::npos && !rule.has_level))
    throw std::invalid_argument(
        fmt::format("--join-marker: '{}' is no marker; expected a channel and a level in SI, like "
                    "trigger>2.5, or trigger<2.5 "
                    "for a fall",
                    text));
  return rule;
}

/// "9.1 s", "3.2, 9.1 s", "3.2, 9.1, 10.4 s and 12 more"
std::string moments(const std::vector<double>& times_s) {
  constexpr std::size_t most_named = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(times_s.size(), most_named); ++i)
    text += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", times_s[i]);
  text += " s";
  if (times_s.size() > most_named) text += fmt::format(" and {} more", times_s.size() - most_named);
  return text;
}

/// Those without a partner; `place` tells a pair's place in `times_s`. With `between` only those between the
/// first and the last pair: what lies outside of them may be before or after the other file.
template <typename Place>
std::vector<double> without_partner(const std::vector<double>& times_s, const MarkerPairs& pairs,
                                    const Place& place, bool between) {
  std::vector<double> alone;
  auto next = pairs.begin();
  for (std::size_t at = 0; at < times_s.size(); ++at) {
    if (next != pairs.end() && place(*next) == at) {
      ++next;
    } else if (!between || (next != pairs.begin() && next != pairs.end())) {
      alone.push_back(times_s[at]);
    }
  }
  return alone;
}
constexpr auto of_first = [](const auto& pair) { return pair.first; };
constexpr auto of_other = [](const auto& pair) { return pair.second; };

[[noreturn]] void refuse(const Markers& first, const Markers& other, const MarkerMatch& match,
                         double most_off_s) {
  const std::string counts = fmt::format("{} markers in the first file and {} in the other",
                                         first.time_s.size(), other.time_s.size());
  if (match.pairs.size() < 2)
    throw std::invalid_argument(
        fmt::format("{} do not fit each other to within {:.3g} s and a clock error of 0.5 %; are they of one "
                    "event, and the levels right?",
                    counts, most_off_s));
  const auto alone = [&](const char* file, const std::vector<double>& times_s) {
    return times_s.empty() ? "" : fmt::format(", of the {} not those at {}", file, moments(times_s));
  };
  throw std::invalid_argument(fmt::format(
      "{} do not fit each other: {} at most lie together to within {:.3g} s{}{}, and {} with another shift; "
      "expected three, two thirds, and two more than with any other shift (seconds after a file's first row)",
      counts, match.pairs.size(), most_off_s,
      alone("first", without_partner(first.time_s, match.pairs, of_first, false)),
      alone("other", without_partner(other.time_s, match.pairs, of_other, false)), match.next_best));
}

/// Those of the shorter file laid on each stretch of the longer one. Empty if none fits.
/// @throws std::invalid_argument if several do.
MarkerPairs laid_on_a_stretch(const std::vector<double>& a, const std::vector<double>& b, double most_off_s) {
  const std::size_t count = std::min(a.size(), b.size());
  const std::size_t places = std::max(a.size(), b.size()) - count + 1;
  MarkerPairs best;
  std::size_t serving = 0;
  for (std::size_t from = 0; from < places; ++from) {
    MarkerPairs pairs;
    for (std::size_t i = 0; i < count; ++i)
      pairs.emplace_back(i + (a.size() > b.size() ? from : 0), i + (a.size() > b.size() ? 0 : from));
    if (!is_of_clocks(line_through(a, b, pairs), most_off_s)) continue;
    ++serving;
    best = std::move(pairs);
  }
  if (serving > 1)
    throw std::invalid_argument(
        fmt::format("{} markers in the first file and {} in the other: {} shifts serve alike; expected as "
                    "many in both, or unequal times between them",
                    a.size(), b.size(), serving));
  return best;
}

}  // namespace

std::vector<MarkerRule> parse_markers(std::string_view text) {
  const auto comma = text.find(',');
  std::vector<MarkerRule> rules{rule_of(text.substr(0, comma))};
  rules.push_back(comma == std::string_view::npos ? rules.front() : rule_of(text.substr(comma + 1)));
  return rules;
}

Markers markers_of(const ClockedSeries& series, const MarkerRule& rule) {
  std::vector<double> values = series.values;
  if (values.size() < 2) throw std::invalid_argument("it has fewer than two rows");
  const double sign = rule.falls ? -1.0 : 1.0;  // a fall is a rise of the channel upside down
  for (double& value : values) value *= sign;
  const auto [least, most] = std::ranges::minmax_element(values);
  const double range = *most - *least;
  const double level = rule.has_level ? sign * rule.level : *least + 0.5 * range;
  Markers markers{.time_s = {}, .period_s = median_period(series.time_s)};
  const double rearm = level - std::min(0.1 * range, 0.5 * (level - *least));
  bool is_below = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < rearm) is_below = true;
    if (!is_below || values[i] < level || i == 0) continue;
    is_below = false;
    const double step = values[i] - values[i - 1];
    const double share = step >= 0.5 * range || step <= 0.0 ? 0.5 : (level - values[i - 1]) / step;
    markers.time_s.push_back(std::lerp(series.time_s[i - 1], series.time_s[i], share));
  }
  if (markers.time_s.empty())
    throw std::invalid_argument(fmt::format("'{}' never {} through {:.6g}; it goes from {:.6g} to {:.6g}",
                                            rule.channel, rule.falls ? "falls" : "rises", sign * level,
                                            std::min(sign * *least, sign * *most),
                                            std::max(sign * *least, sign * *most)));
  return markers;
}

ClockFit fit_markers(const Markers& first, const Markers& other) {
  const double most_off_s = most_steps_off * (first.period_s + other.period_s);
  MarkerPairs pairs = laid_on_a_stretch(first.time_s, other.time_s, most_off_s);
  if (pairs.empty()) {
    MarkerMatch match = match_markers(first.time_s, other.time_s, most_off_s);
    if (!match.is_sure) refuse(first, other, match, most_off_s);
    pairs = std::move(match.pairs);
  }
  const ClockLine line = line_through(first.time_s, other.time_s, pairs);
  const double known = (first.period_s * first.period_s + other.period_s * other.period_s) / 12.0;
  const double residual = pairs.size() > 2 ? line.squares / static_cast<double>(pairs.size() - 2) : 0.0;
  const double variance = std::max(known, residual);
  const auto n = static_cast<double>(pairs.size());
  ClockFit fit{.shift_s = line.shift_s, .skew = line.skew, .correlation = no_value, .rows = 0};
  fit.markers = pairs.size();
  fit.t95 = residual > known ? t95_of(pairs.size() - 2) : 1.96;
  fit.skew_error = pairs.size() > 1 ? std::sqrt(variance / line.spread) : no_value;
  fit.shift_error_s =
      pairs.size() > 1 ? std::sqrt(variance * (1.0 / n + line.mean_other_s * line.mean_other_s / line.spread))
                       : std::sqrt(variance);
  fit.first_alone_s = without_partner(first.time_s, pairs, of_first, true);
  fit.other_alone_s = without_partner(other.time_s, pairs, of_other, true);
  return fit;
}

}  // namespace kerf::bench
