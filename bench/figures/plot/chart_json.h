#pragma once

#include <nlohmann/json.hpp>

#include "plot/plot.h"

namespace kerf::bench {

/// A chart for who draws it in another way than gnuplot, such as the studio's page: what Chart has, by the
/// names that it has there, but its size and the place of its legend. Colours and marks by name ("blue",
/// "points"), a range as [begin, end] or, where it is empty, null, and null for numbers that are not finite.
[[nodiscard]] nlohmann::ordered_json chart_to_json(const Chart& chart);
/// The chart again, in its usual size. What is missing is as a Chart has it by itself, so that a chart that
/// somebody else describes needs labels and curves alone.
/// @throws nlohmann::json::exception for a part of another type; std::invalid_argument for a colour or mark
/// that there is not, and a curve whose x and y are not of one length.
[[nodiscard]] Chart chart_from_json(const nlohmann::ordered_json& json);

}  // namespace kerf::bench
