#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// Whether the law held its rate, for the top of the page. `check` is the JSON of `kerf check`.
/// @throws std::invalid_argument if it lacks what `kerf check` writes; so does loop_section().
[[nodiscard]] std::string verdict_paragraph(const nlohmann::ordered_json& check);

/// The closed loop's stages, deadlines and real-time measures.
[[nodiscard]] std::string loop_section(const nlohmann::ordered_json& check);

}  // namespace kerf::bench
