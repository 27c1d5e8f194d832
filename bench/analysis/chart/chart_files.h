#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "chart/speed_accuracy.h"

namespace kerf::bench {

/// Everything about a chart, one object a point. Each names the file of its law that write_chart() writes.
[[nodiscard]] nlohmann::ordered_json chart_as_json(const SpeedAccuracy& chart);

/// One row a point, its units in the head; of what ends in "_n" the last column says which.
[[nodiscard]] std::string chart_csv(const SpeedAccuracy& chart);

/// One self-contained page: the picture, the front, every point, and what was left out.
[[nodiscard]] std::string chart_page(const SpeedAccuracy& chart);

/// Where write_chart() puts the law of each point within its folder: "points/piecewise-5-segments.law.toml".
[[nodiscard]] std::vector<std::string> point_file_names(const SpeedAccuracy& chart);

/// Writes chart.svg, chart.csv, chart.json, chart.html and the law of every point into a folder.
/// @throws std::system_error.
void write_chart(const SpeedAccuracy& chart, const std::filesystem::path& folder);

}  // namespace kerf::bench
