#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recordings/axis_series.h"
#include "recordings/row_span.h"
#include "signal/blocked_values.h"

namespace kerf::bench {

/// By which rows laws are fitted and judged.
enum class Counted : std::uint8_t {
  contact,  ///< those in which the tool meets something; laws run through the others
  all
};

/// The rows in which a tool meets something.
struct ContactRows {
  double least = 0.0;          ///< beyond which a force is felt, in its unit
  std::vector<RowSpan> spans;  ///< increase and do not touch
  std::size_t rows = 0;        ///< in all of them
};

/// In contact is a row whose force is felt: beyond `felt_n`, the JND's threshold, and beyond four standard
/// deviations of its noise from row to row; what lies less than 0.5 s between two such rows; and 0.1 s before
/// and after. So the moment of contact counts, and a tissue that gives way for a moment, but not a tool that
/// was put down, which would outnumber all cycles. Needs no more memory for a day than for a second, but for
/// the spans themselves.
[[nodiscard]] ContactRows contact_rows(const BlockedValues& time_s, const BlockedValues& force,
                                       double felt_n);

/// Marks the rows in contact as those that count. Where fewer than 20 rows are in contact, all count. Returns
/// how many count.
std::size_t mark_contact(AxisSeries& series, double felt_n);

}  // namespace kerf::bench
