#pragma once

#include <nlohmann/json.hpp>

#include "plot/plot.h"
#include "stability/findings.h"
#include "stability/plane/plane.h"

namespace kerf::bench {

/// Numbers, table, picture and words of a plane.
[[nodiscard]] Findings findings_of(const PlaneMap& map, const StudiedAxis& on = {});

/// The picture of what findings_of() wrote: both axes logarithmic, the cells by what the wall did, the lines,
/// and the device's walls with their stiffness.
/// @throws nlohmann::json::exception if it lacks what a plane has; std::invalid_argument for a behaviour that
/// is none, and for cells that are no grid.
[[nodiscard]] Chart plane_picture(const nlohmann::ordered_json& study);

}  // namespace kerf::bench
