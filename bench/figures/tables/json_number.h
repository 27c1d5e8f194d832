#pragma once

#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// A number as JSON knows it: what is not finite is null, and so is what is not there.
[[nodiscard]] inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}
[[nodiscard]] inline nlohmann::ordered_json json_number(const std::optional<double>& value) {
  return value ? json_number(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace kerf::bench
