#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "recordings/row_span.h"
#include "signal/blocked_values.h"

namespace kerf::bench {

/// How long a signal stands at the smallest or the largest value it has.
struct EndOfRange {
  static constexpr std::size_t most_runs = 100;

  double value = 0.0;
  std::uint64_t rows = 0;     ///< at it
  std::uint64_t longest = 0;  ///< in a row
  std::uint64_t runs = 0;     ///< of ten rows and more
  std::vector<RowSpan> first_runs;
  /// Whether what is measured went on while the signal stood there; unknown where nothing else moved either.
  std::optional<bool> is_clipped = false;
};

struct EndsOfRange {
  EndOfRange least;
  EndOfRange most;
  std::uint64_t longest_between = 0;  ///< rows in a row at any other value but 0
};

/// A sensor at the end of its range repeats one number. It is clipped there if it does so for ten rows and
/// more, three times as long as it stands at any value between (a quiet sensor with coarse steps stands
/// anywhere), while `position` moves by more than four times its noise; where the position stands, it may be
/// a hold, and nobody knows. At 0 nothing is clipped: that is a dead zone. `least` and `most` are those of
/// `values`.
[[nodiscard]] EndsOfRange ends_of_range(const BlockedValues& values, double least, double most,
                                        const BlockedValues& position, double position_noise);

/// Of a force, by the position of the tool beside it; values that are not finite end nowhere.
[[nodiscard]] EndsOfRange ends_of_force(const BlockedValues& force, const BlockedValues& position);

}  // namespace kerf::bench
