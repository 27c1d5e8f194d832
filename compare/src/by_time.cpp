#include "by_time.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "kerf/compare/diagnose.h"

namespace kerf::compare {
namespace {

constexpr double gap_periods = 2.5;  ///< a longer step is none that a straight line could stand for

std::vector<double> times_of(const Series& series) {
  if (!series.time_s.empty()) return series.time_s;
  std::vector<double> times;
  for (std::size_t row = 0; row < series.rows(); ++row) times.push_back(series.time_of(row));
  return times;
}

/// What times are told apart by.
double slack_of(const std::vector<double>& times) { return 1e-9 * std::max(1.0, std::abs(times.back())); }

std::vector<TimeGap> gaps_in(const std::vector<double>& times, double period_s, bool of_got) {
  std::vector<TimeGap> gaps;
  for (std::size_t row = 1; row < times.size(); ++row) {
    if (times[row] - times[row - 1] > gap_periods * period_s)
      gaps.push_back({.of_got = of_got, .begin_s = times[row - 1], .end_s = times[row]});
  }
  return gaps;
}

/// Times that lie in gaps, one after another.
class InGaps {
 public:
  InGaps(std::vector<TimeGap>& gaps, double slack_s)
      : gap_(gaps.begin()), end_(gaps.end()), slack_s_(slack_s) {}

  /// Whether this time, which is later than those before, lies in one, where it is then counted.
  bool take(double time_s) {
    while (gap_ != end_ && time_s >= gap_->end_s - slack_s_) ++gap_;
    if (gap_ == end_ || time_s <= gap_->begin_s + slack_s_) return false;
    ++gap_->rows;
    return true;
  }

 private:
  std::vector<TimeGap>::iterator gap_;
  std::vector<TimeGap>::iterator end_;
  double slack_s_;
};

void add_told(const std::vector<TimeGap>& gaps, Aligned& result) {
  std::size_t rows = 0;
  std::size_t count = 0;
  TimeGap longest;
  for (const TimeGap& one : gaps) {
    if (one.rows == 0) continue;  // the other run has none there either
    rows += one.rows;
    ++count;
    if (one.end_s - one.begin_s > longest.end_s - longest.begin_s) longest = one;
    result.gaps.push_back(one);
  }
  if (count == 0) return;
  result.notes.push_back(fmt::format(
      "the {} run has {} in time, the longest of {:.4g} ms after {:.4g} s: {} rows of the other lie "
      "in there and are not compared",
      longest.of_got ? "second" : "first", count == 1 ? "a gap" : fmt::format("{} gaps", count),
      1e3 * (longest.end_s - longest.begin_s), longest.begin_s, rows));
}

}  // namespace

Series at_times(const Series& got, const std::vector<double>& times) {
  const std::vector<double> own = times_of(got);
  Series result{.time_s = times, .period_s = got.period_s};
  std::vector<std::pair<std::size_t, double>> places;  // row before, share of the way to the next
  std::size_t row = 0;
  for (const double time : times) {
    while (row + 2 < own.size() && own[row + 1] <= time) ++row;
    const double step = own.size() > 1 ? own[row + 1] - own[row] : 1.0;
    places.emplace_back(row, own.size() > 1 ? std::clamp((time - own[row]) / step, 0.0, 1.0) : 0.0);
  }
  const auto take = [&](const std::vector<Channel>& from, std::vector<Channel>& to) {
    for (const Channel& one : from) {
      to.push_back({.name = one.name, .unit = one.unit});
      for (const auto& [before, share] : places) {
        const double value = one.value[before];
        // A whole row is taken as it is, to the last bit.
        to.back().value.push_back(share == 0.0   ? value
                                  : share == 1.0 ? one.value[before + 1]
                                                 : value + share * (one.value[before + 1] - value));
      }
    }
  };
  take(got.channels, result.channels);
  take(got.positions, result.positions);
  take(got.velocities, result.velocities);
  return result;
}

Aligned by_time(const Series& expected, Series got, double lag_s) {
  got.time_s = times_of(got);
  for (double& time : got.time_s) time -= lag_s;
  const std::vector<double> times = times_of(expected);
  const double slack_s = slack_of(times);
  std::vector<TimeGap> gaps = gaps_in(got.time_s, got.period(), true);
  InGaps in_gaps(gaps, slack_s);
  std::vector<std::size_t> rows;
  std::vector<double> chosen;
  std::size_t alone = 0;
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (times[row] < got.time_s.front() - slack_s || times[row] > got.time_s.back() + slack_s) {
      ++alone;
      continue;
    }
    if (in_gaps.take(times[row])) continue;
    rows.push_back(row);
    chosen.push_back(times[row]);
  }
  if (rows.size() < 2)
    throw std::invalid_argument(fmt::format(
        "the times do not overlap: {:.6g} to {:.6g} s and {:.6g} to {:.6g} s; align by tick or lag",
        times.front(), times.back(), got.time_s.front(), got.time_s.back()));
  Aligned result{.expected = rows_of(expected, rows), .got = at_times(got, chosen)};
  result.expected.time_s = chosen;
  if (alone > 0)
    result.notes.push_back(fmt::format("{} of {} rows lie at times that only one run has, and are left out",
                                       alone, times.size()));
  add_told(gaps, result);
  std::vector<TimeGap> own = gaps_in(times, expected.period(), false);
  InGaps in_own(own, slack_s);
  for (const double time : got.time_s) in_own.take(time);
  add_told(own, result);
  return result;
}

}  // namespace kerf::compare
