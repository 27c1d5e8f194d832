#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <kerf/schema/recorded_rows.h>

namespace kerf::bench {

/// A place where rows are missing.
struct SamplingGap {
  std::uint64_t row = 0;            ///< the first one after it
  double begin_s = 0.0;             ///< time of the row before
  double seconds = 0.0;             ///< from that row to this one
  std::uint64_t missing_ticks = 0;  ///< 0 where the ticks go on
};

/// When the rows of a recording were taken.
struct Sampling {
  static constexpr std::size_t most_gaps = 100;

  std::uint64_t rows = 0;
  double duration_s = 0.0;
  double period_s = 0.0;                ///< median step
  std::optional<double> true_rate_hz;   ///< steps over the time that they take, gaps left out
  std::optional<double> jitter_s;       ///< standard deviation of the steps, gaps left out
  std::optional<double> shortest_s;     ///< step
  std::optional<double> longest_s;      ///< step that is no gap
  std::optional<double> resolution_s;   ///< of the time stamps, where all steps are multiples of one
  std::uint64_t gaps = 0;               ///< as RowFigures counts them
  std::vector<SamplingGap> first_gaps;  ///< most_gaps at most
  std::uint64_t repeated = 0;           ///< times that are those of the row before
  std::uint64_t backward = 0;           ///< and that are earlier
  std::uint64_t not_finite = 0;
};

/// Goes through the times some at a time. With less than two rows nothing is known but their number.
///
/// The resolution is the least distance between the different steps there are, told by the nanosecond: clocks
/// that count whole milliseconds take steps of 2, 3 and 4 ms. Unknown where all steps are alike, a thousand
/// differ, or some are no multiples of it.
[[nodiscard]] Sampling sampling_of(const schema::RecordedRows& rows);

}  // namespace kerf::bench
