#include "clocks/marker_fit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "files/trimmed.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double most_skew = 5e-3;
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
  const auto at = text.find('>');
  rule.channel = trimmed(text.substr(0, at));
  if (at != std::string_view::npos) {
    const std::string_view level = trimmed(text.substr(at + 1));
    const char* const end = level.data() + level.size();
    const auto [rest, error] = std::from_chars(level.data(), end, rule.level);
    rule.has_level = error == std::errc() && rest == end && std::isfinite(rule.level);
  }
  if (rule.channel.empty() || (at != std::string_view::npos && !rule.has_level))
    throw std::invalid_argument(fmt::format(
        "--join-marker: '{}' is no marker; expected a channel and a level in SI, like trigger>2.5", text));
  return rule;
}

/// A line through markers that are taken for the same, those of `a` from `from` on.
struct Line {
  double shift_s = 0.0;
  double skew = 0.0;
  double mean_other_s = 0.0;
  double spread = 0.0;   ///< sum of squares of the other's times about their mean [s²]
  double squares = 0.0;  ///< of the residuals [s²]
  double most_off_s = 0.0;
};

Line line_through(const std::vector<double>& a, std::size_t from_a, const std::vector<double>& b,
                  std::size_t from_b, std::size_t count) {
  Line line;
  double mean_a = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    mean_a += a[from_a + i] / static_cast<double>(count);
    line.mean_other_s += b[from_b + i] / static_cast<double>(count);
  }
  double together = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double of_b = b[from_b + i] - line.mean_other_s;
    line.spread += of_b * of_b;
    together += of_b * (a[from_a + i] - mean_a - of_b);
  }
  line.skew = count > 1 ? together / line.spread : 0.0;
  line.shift_s = mean_a - (1.0 + line.skew) * line.mean_other_s;
  for (std::size_t i = 0; i < count; ++i) {
    const double off = a[from_a + i] - line.shift_s - (1.0 + line.skew) * b[from_b + i];
    line.squares += off * off;
    line.most_off_s = std::max(line.most_off_s, std::abs(off));
  }
  return line;
}

bool fits(const Line& line, double step_s) {
  // The skew is known to within what two markers at the ends leave open.
  const double open = line.spread > 0.0 ? most_steps_off * step_s / std::sqrt(line.spread) : 0.0;
  return line.most_off_s <= most_steps_off * step_s && std::abs(line.skew) <= most_skew + open;
}

}  // namespace

std::vector<MarkerRule> parse_markers(std::string_view text) {
  const auto comma = text.find(',');
  std::vector<MarkerRule> rules{rule_of(text.substr(0, comma))};
  rules.push_back(comma == std::string_view::npos ? rules.front() : rule_of(text.substr(comma + 1)));
  return rules;
}

Markers markers_of(const ClockedSeries& series, const MarkerRule& rule) {
  const auto& values = series.values;
  if (values.size() < 2) throw std::invalid_argument("it has fewer than two rows");
  const auto [least, most] = std::ranges::minmax_element(values);
  const double range = *most - *least;
  const double level = rule.has_level ? rule.level : *least + 0.5 * range;
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
    throw std::invalid_argument(fmt::format("'{}' never rises through {:.6g}; it goes from {:.6g} to {:.6g}",
                                            rule.channel, level, *least, *most));
  return markers;
}

ClockFit fit_markers(const Markers& first, const Markers& other) {
  const auto& a = first.time_s;
  const auto& b = other.time_s;
  const double step_s = first.period_s + other.period_s;
  const std::size_t count = std::min(a.size(), b.size());
  const std::size_t places = std::max(a.size(), b.size()) - count + 1;
  std::optional<Line> best;
  std::size_t serving = 0;
  for (std::size_t from = 0; from < places; ++from) {
    const bool is_longer = a.size() > b.size();
    const Line line = line_through(a, is_longer ? from : 0, b, is_longer ? 0 : from, count);
    if (!fits(line, step_s)) continue;
    ++serving;
    if (!best || line.squares < best->squares) best = line;
  }
  if (!best)
    throw std::invalid_argument(
        fmt::format("{} markers and {} do not fit each other to within {:.3g} s and a clock error of 0.5 %; "
                    "one is missing, "
                    "or the level catches what is none",
                    a.size(), b.size(), most_steps_off * step_s));
  if (serving > 1)
    throw std::invalid_argument(
        fmt::format("{} markers and {}: {} shifts serve alike; expected as many in both, or unequal times "
                    "between them",
                    a.size(), b.size(), serving));
  const double known = (first.period_s * first.period_s + other.period_s * other.period_s) / 12.0;
  const double residual = count > 2 ? best->squares / static_cast<double>(count - 2) : 0.0;
  const double variance = std::max(known, residual);
  const auto n = static_cast<double>(count);
  ClockFit fit{.shift_s = best->shift_s, .skew = best->skew, .correlation = no_value, .rows = 0};
  fit.markers = count;
  fit.t95 = residual > known ? t95_of(count - 2) : 1.96;
  fit.skew_error = count > 1 ? std::sqrt(variance / best->spread) : no_value;
  fit.shift_error_s =
      count > 1 ? std::sqrt(variance * (1.0 / n + best->mean_other_s * best->mean_other_s / best->spread))
                : std::sqrt(variance);
  return fit;
}

}  // namespace kerf::bench
