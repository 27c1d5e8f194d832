#include "inspect/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "recordings/axis_values.h"
#include "recordings/row_figures.h"

namespace kerf::bench {
namespace {

constexpr double longest_told_apart_s = 1e6;  // what is longer has no nanoseconds

/// The different steps, as long as they are few.
class DifferentSteps {
 public:
  void add(double step_s) {
    if (found_.size() <= most) found_.insert(std::llround(1e9 * step_s));
  }
  [[nodiscard]] std::optional<double> distance_s() const {
    if (found_.size() < 2 || found_.size() > most) return std::nullopt;
    long long least = *found_.rbegin();
    for (auto step = std::next(found_.begin()); step != found_.end(); ++step)
      least = std::min(least, *step - *std::prev(step));
    // A clock that counts otherwise differs in its last digits; that is no resolution.
    constexpr long long rounding_ns = 2;
    const bool counts = least > 100 * rounding_ns && std::ranges::all_of(found_, [&](long long step) {
                          const long long rest = step % least;
                          return std::min(rest, least - rest) <= rounding_ns;
                        });
    return counts ? std::optional(1e-9 * static_cast<double>(least)) : std::nullopt;
  }

 private:
  static constexpr std::size_t most = 1000;
  std::set<long long> found_;
};

/// Mean and standard deviation of steps, about the median of all so that nothing cancels.
class Spread {
 public:
  explicit Spread(double about) : about_(about) {}
  void add(double step) {
    const double off = step - about_;
    ++count_;
    sum_ += off;
    squares_ += off * off;
    least_ = std::min(least_, step);
    most_ = std::max(most_, step);
  }
  void put_into(Sampling& sampling) const {
    if (count_ == 0) return;
    const auto count = static_cast<double>(count_);
    const double mean = sum_ / count;
    if (about_ + mean > 0.0) sampling.true_rate_hz = 1.0 / (about_ + mean);
    sampling.jitter_s = std::sqrt(std::max(0.0, squares_ / count - mean * mean));
    sampling.shortest_s = least_;
    sampling.longest_s = most_;
  }

 private:
  double about_;
  std::uint64_t count_ = 0;
  double sum_ = 0.0;
  double squares_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity();
  double most_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

Sampling sampling_of(const schema::RecordedRows& rows) {
  Sampling sampling{.rows = rows.rows()};
  if (rows.rows() == 0) return sampling;
  const BlockedValues time_s = axis_values(rows, schema::Column::time);
  sampling.duration_s = time_s[rows.rows() - 1] - time_s[0];
  sampling.period_s = median_step(rows);
  DifferentSteps steps;
  Spread spread(sampling.period_s);
  std::vector<std::uint64_t> ticks;
  std::uint64_t tick_before = 0;
  for (std::uint64_t row = 0; row < rows.rows(); ++row) {
    if (row % BlockedValues::block == 0) {
      ticks.resize(std::min<std::uint64_t>(BlockedValues::block, rows.rows() - row));
      rows.read_ticks(row, ticks);
    }
    const std::uint64_t tick = ticks[row % BlockedValues::block];
    sampling.not_finite += std::isfinite(time_s[row]) ? 0 : 1;
    if (row > 0) {
      const double step_s = time_s[row] - time_s[row - 1];
      sampling.repeated += step_s == 0.0 ? 1 : 0;
      sampling.backward += step_s < 0.0 ? 1 : 0;
      const bool jumps = tick > tick_before + 1;
      if (jumps || step_s > gap_in_periods * sampling.period_s) {
        ++sampling.gaps;
        if (sampling.first_gaps.size() < Sampling::most_gaps)
          sampling.first_gaps.push_back({.row = row,
                                         .begin_s = time_s[row - 1],
                                         .seconds = step_s,
                                         .missing_ticks = jumps ? tick - tick_before - 1 : 0});
      } else if (step_s > 0.0) {
        spread.add(step_s);
        if (step_s < longest_told_apart_s) steps.add(step_s);
      }
    }
    tick_before = tick;
  }
  spread.put_into(sampling);
  sampling.resolution_s = steps.distance_s();
  return sampling;
}

}  // namespace kerf::bench
