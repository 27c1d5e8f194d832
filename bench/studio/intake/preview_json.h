#pragma once

#include <nlohmann/json.hpp>

#include "import/preview.h"
#include "intake/uploads.h"

namespace kerf::bench {

/// What a page shows of a file before it is imported:
///
///     {"columns": [{"number", "heading", "name", "unit", "unknown_unit", "stamps"}],
///      "lines": [{"number", "kind", "fields"}], "irregular": [the same],
///      "layout": {"separator", "decimal", "header_line", "units_line", "preamble_lines"},
///      "suggested": {"map", "has_time"}, "mapped": [{"channel", "column", "unit", "unit_from_file", "si"}],
///      "units": {CHANNEL: [units to choose from]}, "problem", "warnings", "notes", "rows", "seconds",
///      "is_whole"}
[[nodiscard]] nlohmann::ordered_json preview_as_json(const ImportPreview& preview, const ImportHead& head,
                                                     const Upload& upload);

}  // namespace kerf::bench
