#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "editor/segment_editor.h"

namespace kerf::bench {

// What the page of the segment editor is told and says: EditorCurve, Knots and LawError of its api.ts.

[[nodiscard]] nlohmann::ordered_json curve_as_json(const EditorCurve& curve, const std::string& recording);
[[nodiscard]] nlohmann::ordered_json knots_as_json(const Knots& knots);
[[nodiscard]] nlohmann::ordered_json law_error_as_json(const LawError& error);

/// The breakpoints in `object[name]`, checked. @throws RequestError 400; std::invalid_argument as
/// check_knots() does.
[[nodiscard]] Knots knots_in(const nlohmann::json& object, const std::string& name);

}  // namespace kerf::bench
