#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "inspect/counted_rows.h"
#include "recordings/axis_series.h"

namespace kerf::bench {

/// Marks the rows of a series by which the laws of a fit.json were judged: in contact or all, beyond the
/// force that it was told is felt, and of the cycles that it took. Cycles that it has listed by their numbers
/// are those only of a recording that has the same cycles still; else good ones are taken. Where there is no
/// fit (an empty value), as fits judge unless they are asked otherwise.
CountedRows mark_judged(AxisSeries& series, const schema::Recording& recording, std::size_t axis,
                        const nlohmann::ordered_json& fits);

/// Whether a law is judged by a row.
[[nodiscard]] inline bool is_judged(const AxisSeries& series, std::size_t row) {
  return series.counts.empty() || series.counts[row] != 0;
}

}  // namespace kerf::bench
