#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <kerf/schema/recorded_rows.h>

#include "recordings/contact_rows.h"

namespace kerf::bench {

/// One closing of a tool and what belongs to it, in SI; forces resist the closing.
struct CycleFacts {
  std::uint32_t number = 0;
  RowSpan rows;             ///< of all its phases
  double begin_s = 0.0;     ///< time of its first row
  double duration_s = 0.0;  ///< to its last row
  double wait_s = 0.0;      ///< open, before the closing
  double closing_s = 0.0;
  double hold_s = 0.0;              ///< closed, before the opening
  double idle_hold_s = 0.0;         ///< of that out of contact
  std::optional<double> opening_s;  ///< none: it does not open again
  double peak = 0.0;                ///< largest force from the begin of the closing on
  double closing_work = 0.0;        ///< from the begin of the closing to the most closed row [work_unit()]
  double work = 0.0;                ///< from there to the end of the opening, all that was not given back
  std::uint64_t clipped_rows = 0;   ///< at an end of the sensor's range, if it is clipped there
  std::uint64_t gaps = 0;           ///< where rows are missing
};

/// What is known beside the rows of a recording.
struct CycleContext {
  const ContactRows& contact;
  std::optional<double> clipped_low;  ///< force at which the sensor is clipped, as it was recorded
  std::optional<double> clipped_high;
  double period_s = 0.0;  ///< usual step
};

/// Every cycle in turn. Works are sums over the rows as they are, by the trapezoidal rule.
/// @throws schema::FormatError for phases of rows that are not there.
[[nodiscard]] std::vector<CycleFacts> cycle_facts(const schema::RecordedRows& rows,
                                                  const schema::Cycles& cycles, const CycleContext& context);

}  // namespace kerf::bench
