#pragma once

#include <nlohmann/json.hpp>

#include "plot/plot.h"

namespace kerf::bench {

/// A chart for who draws it in another way than gnuplot, such as the studio's page: what Chart has, by the
/// names that it has there, but its size and the place of its legend. Colours and marks by name ("blue",
/// "points"), a range as [begin, end] or, where it is empty, null, and null for numbers that are not finite.
[[nodiscard]] nlohmann::ordered_json chart_to_json(const Chart& chart);

}  // namespace kerf::bench
