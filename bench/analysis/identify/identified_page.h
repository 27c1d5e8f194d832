#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// What identify.json says, as HTML: of each axis the verdict, its numbers with their intervals, and its
/// charts; then the charts of the whole device, if it has any. Whatever stands under `charts` is drawn, so
/// that who adds a chart to the file need not add it here.
/// @throws nlohmann::json::exception if it lacks what `kerf identify` writes; std::invalid_argument as
/// chart_from_json().
[[nodiscard]] std::string identified_body(const nlohmann::ordered_json& identified);

/// "this model predicts the device to 2.1 %", or why it cannot be said, of the axis of an identify.json.
[[nodiscard]] std::string axis_verdict(const nlohmann::ordered_json& axis);

}  // namespace kerf::bench
