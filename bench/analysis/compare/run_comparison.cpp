#include "compare/run_comparison.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

std::vector<double> times_of_rows(const compare::Series& series) {
  std::vector<double> times;
  times.reserve(series.rows());
  for (std::size_t row = 0; row < series.rows(); ++row) times.push_back(series.time_of(row));
  return times;
}

std::vector<std::array<EventMatch, 3>> events_of(const compare::Aligned& runs, double match_s) {
  std::vector<std::array<EventMatch, 3>> all;
  const std::vector<double> times = times_of_rows(runs.expected);
  for (std::size_t i = 0; i < runs.expected.channels.size(); ++i) {
    const ForceEventOptions options{.jnd = compare::jnd_of(runs.expected.channels[i].unit)};
    all.push_back(match_events(find_force_events(times, runs.expected.channels[i].value, options),
                               find_force_events(times, runs.got.channels[i].value, options), match_s));
  }
  return all;
}

/// Every channel is allowed something, and none that is not there.
void require_tolerances_of(const std::vector<compare::Channel>& channels,
                           const compare::Tolerance& tolerance) {
  for (const compare::ChannelTolerance& one : tolerance.channels) {
    if (!std::ranges::count(channels, one.channel, &compare::Channel::name))
      throw std::invalid_argument(fmt::format("a tolerance is given for '{}', and the forces are {}",
                                              one.channel, compare::names_of(channels)));
  }
  for (const compare::Channel& one : channels) {
    if (!tolerance.of(one.name).has_limit_for(one.unit))
      throw std::invalid_argument(fmt::format(
          "no tolerance is given for '{}' in {}; give exact, relative, jnd or an absolute one in {}",
          one.name, one.unit, one.unit));
  }
}

/// Of most rows nothing is known: that is no agreement.
void require_partners(RunComparison& result, std::size_t rows) {
  const std::size_t compared = result.runs.expected.rows();
  if (2 * compared >= rows) return;
  result.comparison.passed = false;
  result.comparison.messages.push_back(fmt::format(
      "only {} of {} rows have a partner at their time: nothing is known of the others", compared, rows));
}

}  // namespace

RunComparison compare_runs(ComparedRun expected, ComparedRun got, const RunComparisonOptions& options) {
  RunComparison result{.expected = expected.name, .got = got.name, .notes = expected.notes};
  result.notes.insert(result.notes.end(), got.notes.begin(), got.notes.end());
  const std::size_t rows = expected.series.rows();
  const bool by_tick = options.align.by == compare::AlignBy::tick;
  const bool paired = by_tick && got.series.rows() == rows;
  try {
    require_tolerances_of(expected.series.channels, options.tolerance);
    got.series = compare::in_order_of(expected.series, std::move(got.series));
    result.runs = paired
                      ? compare::Aligned{.expected = std::move(expected.series), .got = std::move(got.series)}
                      : compare::aligned(expected.series, got.series, options.align);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{} and {}: {}", result.expected, result.got, error.what()));
  }
  // What is missing is seen in the whole runs alone.
  const bool whole = by_tick && !paired;
  const compare::Series& before = whole ? expected.series : result.runs.expected;
  const compare::Series& after = whole ? got.series : result.runs.got;
  // Beside each other lie rows of one moment.
  if (auto matched = whole ? compare::matched_rows(before, after) : std::nullopt) {
    result.runs = {.expected = rows_of(before, matched->expected), .got = rows_of(after, matched->got)};
    result.ticks = std::move(matched->expected);
  }
  if (result.runs.expected.rows() < 2)
    throw std::invalid_argument(
        fmt::format("{} and {}: fewer than two rows to compare", result.expected, result.got));
  result.notes.insert(result.notes.end(), result.runs.notes.begin(), result.runs.notes.end());
  compare::Tolerance tolerance = options.tolerance;
  // Strokes of other speeds have no common time in which something could vibrate.
  if (options.align.by == compare::AlignBy::position && !tolerance.vibration)
    tolerance.vibration = std::numeric_limits<double>::infinity();
  for_each_index(3, 3, [&](std::size_t part) {
    if (part == 0) {
      result.agreement = compare::agreement(result.runs.expected, result.runs.got, options.align.most_lag_s);
    } else if (part == 1) {
      result.comparison = compare::compare_with_gaps(before, after, tolerance);
    } else {
      result.events = events_of(result.runs, options.match_s);
    }
  });
  if (!by_tick && options.align.by != compare::AlignBy::position) require_partners(result, rows);
  if (result.comparison.passed) return result;
  if (by_tick) {
    result.diagnosis = compare::diagnose(before, after);
  } else {
    // Off the ticks positions are those of other moments: no motion that either was asked for.
    compare::Series expected_run = before;
    expected_run.positions.clear();
    result.diagnosis = compare::diagnose(expected_run, after);
  }
  result.names = compare::sentences_of(result.diagnosis, before);
  return result;
}

std::size_t RunComparison::row_of(std::size_t tick) const {
  if (ticks.empty()) return tick;
  return static_cast<std::size_t>(std::ranges::lower_bound(ticks, tick) - ticks.begin());
}

std::string unknown_lag_in_words(const RunComparison& result) {
  if (!result.runs.no_lag_within_s) return "";
  return fmt::format(
      "lag unknown: it is longer than the {:.4g} ms that were looked for, and nothing is taken out; a larger "
      "--max-lag finds it",
      1e3 * *result.runs.no_lag_within_s);
}

std::vector<std::string> comparison_lines(const RunComparison& result) {
  std::vector<std::string> lines;
  if (const auto& lag = result.runs.lag)
    lines.push_back(fmt::format("lag {:+.4f} ms +- {:.4f} ms ({:+.4g} ticks), taken out", 1e3 * lag->seconds,
                                1e3 * lag->std_error_s, lag->ticks));
  if (const std::string unknown = unknown_lag_in_words(result); !unknown.empty()) lines.push_back(unknown);
  for (std::size_t i = 0; i < result.agreement.size(); ++i) {
    const compare::ChannelAgreement& one = result.agreement[i];
    const compare::ChannelComparison& about = result.comparison.channels[i];
    const std::string& unit = one.channel.unit;
    lines.push_back(fmt::format(
        "{:8} outside {:>7} of {} ticks  largest difference {:.3g} {} ({:.2g} JND)  RMS {:.3g} {}",
        one.channel.name, about.outside, result.comparison.expected_rows, about.largest_difference, unit,
        about.largest_jnds, one.rms_difference, unit));
    if (about.not_finite > 0)
      lines.push_back(
          fmt::format("{:8} not finite in {} ticks, which the numbers here leave out", "", about.not_finite));
    const std::string latency = one.latency_s ? fmt::format("{:+.4g} ms +- {:.2g} ms", 1e3 * *one.latency_s,
                                                            1e3 * one.latency_std_error_s)
                                              : "unknown";
    lines.push_back(fmt::format("{:8} gain {:.5g}  offset {:+.3g} {}  drift {:+.3g} {}  latency {}", "",
                                one.gain, one.offset, unit, one.drift, unit, latency));
    for (std::size_t kind = 0; kind < force_event_names.size(); ++kind) {
      const EventMatch& match = result.events[i][kind];
      if (match.recorded + match.rendered == 0) continue;
      lines.push_back(fmt::format("{:8} {}: {} expected, {} got, {} the same", "", force_event_names[kind],
                                  match.recorded, match.rendered, match.late_s.size()));
      if (!match.late_s.empty())
        lines.back() += fmt::format(", late by {:+.3g} ms on average", 1e3 * match.mean_s());
    }
  }
  for (const std::string& message : result.comparison.messages) lines.push_back(message);
  for (const std::string& name : result.names) lines.push_back(name);
  return lines;
}

}  // namespace kerf::bench
