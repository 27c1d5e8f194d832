#pragma once

#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kerf::bench {

/// A number as JSON knows it: what is not finite is null, and so is what is not there.
[[nodiscard]] inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}
[[nodiscard]] inline nlohmann::ordered_json json_number(const std::optional<double>& value) {
  return value ? json_number(*value) : nlohmann::ordered_json(nullptr);
}

/// The number back: NaN of null.
[[nodiscard]] inline double number_from(const nlohmann::ordered_json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

/// A list of numbers.
template <typename Values>
[[nodiscard]] nlohmann::ordered_json json_numbers(const Values& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const double value : values) list.push_back(json_number(value));
  return list;
}

/// Appends a list of numbers with six digits to the text of a JSON: for lists so long that their size counts.
template <typename Text>
void append_json_numbers(Text& text, std::span<const double> values) {
  text.push_back('[');
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text.push_back(',');
    if (std::isfinite(values[i])) {
      fmt::format_to(std::back_inserter(text), "{:.6g}", values[i]);
    } else {
      fmt::format_to(std::back_inserter(text), "null");
    }
  }
  text.push_back(']');
}

}  // namespace kerf::bench
