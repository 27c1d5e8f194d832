#include "kerf/compare/align.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "by_time.h"
#include "kerf/compare/diagnose.h"
#include "lag.h"

namespace kerf::compare {
namespace {

constexpr std::array<std::string_view, 4> align_names{"tick", "time", "position", "lag"};

void cut_to(Series& series, std::size_t rows) {
  if (series.time_s.size() > rows) series.time_s.resize(rows);
  for (auto* columns : {&series.channels, &series.positions, &series.velocities}) {
    for (Channel& one : *columns) one.value.resize(rows);
  }
}

/// Rows of one move in one direction.
struct Stroke {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool up = true;
};

/// Between reversals of more than `least`.
std::vector<Stroke> strokes_of(const std::vector<double>& position, double least) {
  std::vector<Stroke> strokes;
  std::size_t begin = 0;
  std::size_t lowest = 0;
  std::size_t highest = 0;
  int direction = 0;
  for (std::size_t row = 0; row < position.size(); ++row) {
    if (position[row] < position[lowest]) lowest = row;
    if (position[row] > position[highest]) highest = row;
    const bool rises = position[row] - position[lowest] > least;
    const bool falls = position[highest] - position[row] > least;
    if (direction >= 0 && falls) {
      if (direction > 0) {
        strokes.push_back({begin, highest + 1, true});
        begin = highest;
      }
      direction = -1;
      lowest = row;
    } else if (direction <= 0 && rises) {
      if (direction < 0) {
        strokes.push_back({begin, lowest + 1, false});
        begin = lowest;
      }
      direction = 1;
      highest = row;
    }
  }
  if (direction != 0) strokes.push_back({begin, position.size(), direction > 0});
  return strokes;
}

std::size_t moving_axis(const Series& series) {
  std::size_t most = 0;
  double widest = -1.0;
  for (std::size_t axis = 0; axis < series.positions.size(); ++axis) {
    const auto [low, high] = std::ranges::minmax(series.positions[axis].value);
    const double lever = series.positions[axis].unit == "rad" ? 0.1 : 1.0;  // a hand's breadth
    if (lever * (high - low) > widest) most = axis;
    widest = std::max(widest, lever * (high - low));
  }
  return most;
}

/// Pairs of a row and the place in the other stroke, a row with a fraction, at which its position is met.
void pair_stroke(const std::vector<double>& expected, const Stroke& a, const std::vector<double>& got,
                 const Stroke& b, std::vector<std::size_t>& rows, std::vector<double>& places) {
  const double sign = a.up ? 1.0 : -1.0;
  std::size_t row = b.begin;
  double farthest = -1e300;
  for (std::size_t i = a.begin; i < a.end; ++i) {
    // Onwards alone: a step back within a stroke is noise, or rest.
    if (sign * expected[i] < farthest) continue;
    farthest = sign * expected[i];
    while (row + 1 < b.end && sign * got[row + 1] < farthest) ++row;
    if (row + 1 >= b.end || sign * got[row] > farthest) continue;
    const double step = got[row + 1] - got[row];
    rows.push_back(i);
    places.push_back(static_cast<double>(row) + (step != 0.0 ? (expected[i] - got[row]) / step : 0.0));
  }
}

Aligned by_position(const Series& expected, const Series& got) {
  if (expected.positions.empty() || got.positions.size() != expected.positions.size())
    throw std::invalid_argument("aligning by position needs the same positions in both runs");
  const std::size_t axis = moving_axis(expected);
  const auto& a = expected.positions[axis].value;
  const auto& b = got.positions[axis].value;
  const auto [low, high] = std::ranges::minmax(a);
  const double least = 0.02 * (high - low);
  const auto own = strokes_of(a, least);
  const auto others = strokes_of(b, least);
  if (own.empty() || own.size() != others.size() || own.front().up != others.front().up)
    throw std::invalid_argument(
        fmt::format("'{}' makes {} strokes in one run and {} in the other, or begins in the other direction; "
                    "align by time or lag",
                    expected.positions[axis].name, own.size(), others.size()));
  std::vector<std::size_t> rows;
  std::vector<double> places;
  for (std::size_t i = 0; i < own.size(); ++i) pair_stroke(a, own[i], b, others[i], rows, places);
  if (rows.size() < 2) throw std::invalid_argument("the runs share no position within a stroke");
  Series counted = got;
  counted.time_s.clear();
  counted.period_s = 1.0;
  Aligned result{.expected = rows_of(expected, rows), .got = at_times(counted, places)};
  result.got.time_s = result.expected.time_s;
  result.got.period_s = expected.period_s;
  if (rows.size() < a.size())
    result.notes.push_back(
        fmt::format("{} strokes of '{}' are paired; {} of {} rows are at rest or at positions that only one "
                    "run has, and are left out",
                    own.size(), expected.positions[axis].name, a.size() - rows.size(), a.size()));
  return result;
}

/// What the forces of all channels say together.
struct LagSearch {
  std::optional<Lag> lag;
  double most_s = 0.0;     ///< that was looked for
  bool is_longer = false;  ///< at the longest there is least left of those channels that tell of any
};

LagSearch search_lag(const Series& expected, const Series& got, double most_lag_s) {
  const double period_s = expected.period();
  const auto most = static_cast<std::size_t>(std::max(4.0, most_lag_s / period_s));
  const Stretch rows = longest_stretch(expected.time_s, std::min(expected.rows(), got.rows()), period_s);
  LagSearch result{.most_s = std::min(most_lag_s, static_cast<double>(rows.count / 4) * period_s)};
  double weights = 0.0;
  double sum = 0.0;
  Lag lag;
  double best = 1e300;
  for (std::size_t channel = 0; channel < expected.channels.size(); ++channel) {
    const auto fit = fit_lag(rows.of(expected.channels[channel].value), rows.of(got.channels[channel].value),
                             {.most_ticks = most, .free_gain = true});
    if (!fit) continue;
    if (fit->is_longer || std::abs(fit->ticks) * period_s > most_lag_s + 0.5 * period_s) {
      result.is_longer = true;
      continue;
    }
    const double error = std::max(fit->std_error, 1e-9);
    weights += 1.0 / (error * error);
    sum += fit->ticks / (error * error);
    if (error < best) lag.channel = expected.channels[channel].name;
    best = std::min(best, error);
  }
  if (weights == 0.0) return result;
  lag.ticks = sum / weights;
  lag.seconds = lag.ticks * period_s;
  lag.std_error_s = period_s / std::sqrt(weights);
  result.lag = lag;
  result.is_longer = false;
  return result;
}

Aligned by_lag(const Series& expected, const Series& got, double most_lag_s) {
  // On one grid first: a lag is told in rows of the same period.
  Series same = got;
  if (!same.time_s.empty()) {
    const double begin = same.time_s.front() - (expected.time_s.empty() ? 0.0 : expected.time_s.front());
    for (double& time : same.time_s) time -= begin;
  }
  Aligned beside = by_time(expected, same, 0.0);
  const LagSearch search = search_lag(beside.expected, beside.got, most_lag_s);
  if (search.is_longer) {
    beside.no_lag_within_s = search.most_s;
    return beside;
  }
  if (!search.lag)
    throw std::invalid_argument(
        "no lag can be told: no force changes, or there are fewer than 80 rows; align by tick or time");
  Aligned result = by_time(expected, same, search.lag->seconds);
  result.lag = search.lag;
  return result;
}

}  // namespace

AlignBy align_by(std::string_view name) {
  const auto found = std::ranges::find(align_names, name);
  if (found == align_names.end())
    throw std::invalid_argument(
        fmt::format("'{}' is no alignment; expected tick, time, position or lag", name));
  return static_cast<AlignBy>(found - align_names.begin());
}

std::string_view name_of(AlignBy by) noexcept { return align_names[static_cast<std::size_t>(by)]; }

std::optional<Lag> lag_between_runs(const Series& expected, const Series& got, double most_lag_s) {
  return search_lag(expected, got, most_lag_s).lag;
}

Aligned aligned(const Series& expected, const Series& got, const AlignOptions& options) {
  switch (options.by) {
    case AlignBy::time:
      return by_time(expected, got, 0.0);
    case AlignBy::position:
      return by_position(expected, got);
    case AlignBy::lag:
      return by_lag(expected, got, options.most_lag_s);
    case AlignBy::tick:
      break;
  }
  Aligned result{.expected = expected, .got = got};
  const std::size_t rows = std::min(expected.rows(), got.rows());
  if (expected.rows() != got.rows())
    result.notes.push_back(
        fmt::format("{} rows beside {}: the first {} are compared", expected.rows(), got.rows(), rows));
  cut_to(result.expected, rows);
  cut_to(result.got, rows);
  return result;
}

}  // namespace kerf::compare
