#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

#include "signal/value_counts.h"

namespace kerf::bench {

/// Two rows that are further apart than this many median periods have a gap between them.
inline constexpr double gap_in_periods = 2.5;

/// Smallest and largest finite value, and how many are not finite.
struct ValueRange {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::uint64_t not_finite = 0;

  void add(double value) noexcept {
    if (!std::isfinite(value)) {
      ++not_finite;
      return;
    }
    min = std::min(min, value);
    max = std::max(max, value);
  }
  friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

/// What a summary says of the rows of a recording.
struct RowFigures {
  std::uint64_t rows = 0;
  double first_s = 0.0;  ///< time of the first row
  double last_s = 0.0;
  double period_s = 0.0;   ///< median step of the time; 0 for less than two rows
  std::uint64_t gaps = 0;  ///< places where ticks are missing, or where a step is far longer than the median
  std::uint64_t repeated = 0;  ///< times that are those of the row before
  std::uint64_t backward = 0;  ///< and that are earlier
  std::uint64_t times_not_finite = 0;
  std::map<schema::Column, std::vector<ValueRange>> columns;  ///< of each axis, or one; those there are
  std::vector<ValueRange> channels;
  friend bool operator==(const RowFigures&, const RowFigures&) = default;
};

/// Median step of the time; 0 for less than two rows. Goes through the times four times.
[[nodiscard]] double median_step(const schema::RecordedRows& rows);

/// Goes through all rows, some at a time, a few times.
[[nodiscard]] RowFigures figures_of(const schema::RecordedRows& rows);

/// The same figures gathered while the rows come, so that none is looked at again. For the rows of a loop,
/// which lie on its grid: each step of the time that differs from the others takes memory.
class RowTally {
 public:
  RowTally(std::size_t axes, std::size_t channels, bool measures_force);

  /// The next rows.
  void add(std::span<const schema::Row> rows);
  [[nodiscard]] RowFigures figures() const;

 private:
  void add_time(const schema::Row& row);

  RowFigures so_far_;  ///< what does not depend on the median step
  std::uint64_t last_tick_ = 0;
  ValueCounts steps_;
  ValueCounts steps_over_missing_ticks_;
  std::uint64_t jumps_ = 0;  ///< of the tick
};

}  // namespace kerf::bench
