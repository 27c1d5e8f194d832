#pragma once

#include <cstddef>

#include <kerf/schema/recorded_rows.h>

#include "signal/blocked_values.h"

namespace kerf::bench {

/// One axis of a column, or one of a value a row, as the rows are read; they stay where they are.
[[nodiscard]] BlockedValues axis_values(const schema::RecordedRows& rows, schema::Column column,
                                        std::size_t axis = 0);

/// Where a recording has its force: measured where there is a sensor, else commanded.
[[nodiscard]] schema::Column force_column(const schema::RecordedRows& rows);

}  // namespace kerf::bench
