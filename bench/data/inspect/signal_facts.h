#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "recordings/row_span.h"
#include "signal/blocked_values.h"

namespace kerf::bench {

/// A row whose value stands out from both its neighbours.
struct SingleRow {
  std::uint64_t row = 0;
  double value = 0.0;
  double height = 0.0;  ///< over the nearer neighbour, positive
};

/// What one column is worth, whatever it measures; in its own unit.
struct SignalFacts {
  static constexpr std::size_t most_outliers = 20;

  std::uint64_t rows = 0;
  std::uint64_t not_finite = 0;
  double least = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no value is finite
  double most = std::numeric_limits<double>::quiet_NaN();

  std::optional<double> quantum;  ///< usual step between values that come again and again
  std::optional<double> noise;    ///< from row to row, its quantum's included; of all rows

  std::uint64_t zeros = 0;          ///< rows that are exactly 0
  std::uint64_t longest_zeros = 0;  ///< in a row
  bool below_zero = false;          ///< some value is
  bool above_zero = false;
  std::optional<double> nearest_zero;  ///< smallest size that is not 0

  std::optional<std::size_t> held_rows;  ///< rows_held()

  std::optional<std::uint64_t> outliers;    ///< unknown where there is no noise to hold them against
  std::vector<SingleRow> largest_outliers;  ///< most_outliers at most, the largest first

  /// Rows that are exactly 0 and ought not to be: one in a hundred or more, where no value lies on one of the
  /// sides, or no other value comes as near as two and a half quanta, or nothing else shows a quantum.
  [[nodiscard]] bool is_blind_at_zero() const;
};

/// Usual step between neighbouring values: the median of the steps between the different values there are.
/// None where fewer than three changes from row to row come on each value (so that a ramp, which meets each
/// of its values once, has none), where fewer than three differ, or more than 262,144.
[[nodiscard]] std::optional<double> quantum_of(const BlockedValues& values);

/// Which rows: those in some spans (`inside`) or outside them; all of them by default.
struct NoiseRows {
  std::span<const RowSpan> spans{};
  bool inside = false;  ///< else outside
};

/// Standard deviation of white noise from row to row, by second differences (signal/row_noise.h). Where there
/// is a quantum, each size of a difference stands for all that were rounded to it, and no less is given than
/// a quantum over sqrt(12); where there is none, values that stand still are held, by a clipped sensor or a
/// motor at rest, and do not count. None where no row counts.
[[nodiscard]] std::optional<double> noise_of(const BlockedValues& values, std::optional<double> quantum,
                                             const NoiseRows& which = {});

/// Range, quantum, noise and zeros.
[[nodiscard]] SignalFacts signal_facts(const BlockedValues& values);

/// Adds the rows that stand out from both their neighbours, in one direction, by more than eight times a
/// noise.
void find_outliers(SignalFacts& facts, const BlockedValues& values, double noise);

}  // namespace kerf::bench
