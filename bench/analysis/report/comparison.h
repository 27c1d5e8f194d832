#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "plot/plot.h"

namespace kerf::bench {

/// All laws of a fit in a table, with a straight line's error as the last row.
[[nodiscard]] std::string comparison_table(const nlohmann::ordered_json& fits, const std::string& force_unit);

/// Their errors as dots, the best on top, and what a person can feel as a line.
[[nodiscard]] Chart comparison_chart(const nlohmann::ordered_json& fits, const std::string& force_unit);

}  // namespace kerf::bench
