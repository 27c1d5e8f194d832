#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

#include "recordings/row_figures.h"

namespace kerf::bench {

/// What is in a recording, as `kerf info --json` and `kerf import --json` give it: samples, duration_s,
/// rate_hz (of the median period), gaps (jumps of the tick, and periods beyond 2.5 times the median),
/// channels with unit, min and max, warnings, and what the file says of itself (schema, status, uuid, axes,
/// cycles, ...).
/// Looks at some rows at a time: in the same memory for a day as for a second.
[[nodiscard]] nlohmann::ordered_json recording_summary(const schema::RecordedRows& rows);
[[nodiscard]] nlohmann::ordered_json recording_summary(const schema::Recording& recording);
/// The same where the figures of the rows are known: `about` says all but them, and none is read.
[[nodiscard]] nlohmann::ordered_json recording_summary(const schema::Recording& about,
                                                       const RowFigures& figures);

/// The same as lines for people.
[[nodiscard]] std::string summary_table(const nlohmann::ordered_json& summary);

}  // namespace kerf::bench
