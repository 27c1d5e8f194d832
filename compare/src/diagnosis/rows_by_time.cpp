#include "diagnosis/rows_by_time.h"

#include <cmath>
#include <limits>

namespace kerf::compare {
namespace {

constexpr double missing_row_periods = 1.5;  ///< a step as long is over a row

/// Whether a clock goes on over what is missing before a row. At the ends of a run it cannot tell.
bool steps_over(const std::vector<double>& times, std::size_t row, double period_s) {
  return row == 0 || times[row] - times[row - 1] > missing_row_periods * period_s;
}

/// Rows less than half a period apart, where those of `got` come so much later. None if a row is without a
/// partner and no clock steps over it: then the clocks differ, and no rows are missing.
std::optional<MatchedRows> paired(const Series& expected, const Series& got, double later_s) {
  const double period_s = expected.period();
  MatchedRows rows{.by_time = true};
  std::size_t i = 0;
  std::size_t j = 0;
  bool missing = false;
  while (i < expected.rows() && j < got.rows()) {
    const double late_s = got.time_s[j] - later_s - expected.time_s[i];
    if (std::abs(late_s) <= 0.5 * period_s) {
      rows.expected.push_back(i++);
      rows.got.push_back(j++);
      missing = false;
      continue;
    }
    const bool lost = late_s > 0.0;
    if (lost ? !steps_over(got.time_s, j, period_s) : !steps_over(expected.time_s, i, period_s)) return {};
    if (!missing) ++rows.edits;
    missing = true;
    ++(lost ? i : j);
  }
  return rows;
}

/// Mean square of the difference, each channel as a share of its own mean square.
double difference_of(const Series& expected, const Series& got, const MatchedRows& rows) {
  double sum = 0.0;
  for (std::size_t channel = 0; channel < expected.channels.size(); ++channel) {
    double left = 0.0;
    double all = 0.0;
    for (std::size_t row = 0; row < rows.expected.size(); ++row) {
      const double e = expected.channels[channel].value[rows.expected[row]];
      const double apart = got.channels[channel].value[rows.got[row]] - e;
      if (!std::isfinite(apart)) continue;
      left += apart * apart;
      all += e * e;
    }
    if (all > 0.0) sum += left / all;
  }
  return sum;
}

}  // namespace

std::optional<MatchedRows> matched_by_time(const Series& expected, const Series& got) {
  constexpr double other_period = 0.1;
  if (expected.time_s.size() < 2 || got.time_s.size() < 2) return {};
  if (std::abs(got.period() / expected.period() - 1.0) > other_period) return {};
  std::optional<MatchedRows> best;
  double least = std::numeric_limits<double>::infinity();
  // A run that begins later lacks rows, or has a clock of its own: as the forces say.
  for (const double later_s : {0.0, got.time_s.front() - expected.time_s.front()}) {
    auto rows = paired(expected, got, later_s);
    if (!rows || 2 * rows->expected.size() < std::min(expected.rows(), got.rows())) continue;
    const double left = difference_of(expected, got, *rows);
    if (!(left < least)) continue;
    least = left;
    best = std::move(rows);
  }
  if (best && best->edits == 0) return {};
  return best;
}

std::vector<Edit> edits_of(const MatchedRows& rows) {
  std::vector<Edit> edits;
  std::size_t i = 0;  // the rows that follow those with a partner
  std::size_t j = 0;
  for (std::size_t pair = 0; pair < rows.expected.size(); ++pair) {
    const std::size_t lost = rows.expected[pair] - i;
    const std::size_t added = rows.got[pair] - j;
    if (lost > 0) edits.push_back({.expected_row = i, .got_row = j, .lost = lost, .first = i});
    if (added > 0) edits.push_back({.expected_row = i, .got_row = j, .added = added, .first = i});
    i = rows.expected[pair] + 1;
    j = rows.got[pair] + 1;
  }
  return edits;
}

}  // namespace kerf::compare
