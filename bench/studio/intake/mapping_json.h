#pragma once

#include <nlohmann/json.hpp>

#include "imports/import_file.h"

namespace kerf::bench {

/// {"map", "options"} as a page sends it. The map is parsed, and may be empty where `needs_map` is false.
/// @throws RequestError 400, std::invalid_argument that quotes the entry.
[[nodiscard]] ImportFile mapping_in(const nlohmann::json& given, bool needs_map);
/// The same for a page.
[[nodiscard]] nlohmann::ordered_json mapping_as_json(const ImportFile& mapping);
/// What import_text() takes.
[[nodiscard]] ImportOptions import_options_of(const ImportFile& mapping);

}  // namespace kerf::bench
