#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "recordings/row_span.h"
#include "signal/blocked_values.h"

namespace kerf::bench {

/// By how much a force comes after the position that it goes with.
struct Lag {
  double seconds = 0.0;  ///< positive: the force comes later, as a filter or a second clock make it;
                         ///< negative: it comes first, as damping and friction do
  double correlation =
      0.0;  ///< of force and position at that lag; negative where one falls as the other grows
  double correlation_now = 0.0;  ///< without a lag
  std::size_t rows = 0;          ///< in contact that it is made of
};

/// The lag at which force and position correlate most, of up to 0.1 s either way: of the rows in contact, in
/// steps of a row or of a millisecond, whichever is longer, and between them by a parabola. Rows are taken to
/// be `period_s` apart. None where nothing correlates by 0.5, the most lies at either end of the range, or
/// fewer than a hundred rows count.
[[nodiscard]] std::optional<Lag> lag_between(const BlockedValues& position, const BlockedValues& force,
                                             std::span<const RowSpan> contacts, double period_s);

}  // namespace kerf::bench
