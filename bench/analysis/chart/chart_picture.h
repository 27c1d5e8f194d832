#pragma once

#include <nlohmann/json.hpp>

#include "plot/plot.h"

namespace kerf::bench {

/// What chart_as_json() wrote, as `chart.svg` and the studio's page show it: cost of a tick [us] over error
/// ([N] or [N·m], or [JND] where several axes are judged), both logarithmic. A colour a law, whose points
/// stand for those of the result, hollow where too many ticks are outside the JND; crosses over what is not
/// stable, rings about what nobody judged (the title says so where nobody judged any), the front by median
/// cost as stairs, that by cold tail as dashed ones, the points of both named, the JND, the tick and half of
/// it as lines. Errors under a ten-thousandth of the JND stand at the left border.
/// @throws nlohmann::json::exception if it lacks what a chart has.
[[nodiscard]] Chart chart_picture(const nlohmann::ordered_json& chart);

}  // namespace kerf::bench
